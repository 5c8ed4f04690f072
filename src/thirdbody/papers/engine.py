"""What every study of a paper does: find, draw, and write ledger and page into its own folder."""

from __future__ import annotations

import json
import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, TypeVar

from ..quantities.files import whole, write_text
from ..quantities.run_files import MARK, claim_folder, read_json
from .page import figures

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["Picture", "Progress", "Summary", "ignore_ranges", "prepare_folder", "reproduce"]

Progress = Callable[[str, int, int], None]
"""Called with stage, steps done, and steps in all."""


@dataclass(frozen=True)
class Picture:
    """A figure with its numbers: written as PNG, SVG and CSV, and shown on the page."""

    stem: str
    """Of its files."""
    name: str
    about: str
    note: str
    drawn: Figure
    csv: str

    def write(self, folder: Path) -> tuple[str, ...]:
        """Write its files; their names. Names inside the SVG come from the stem."""
        from matplotlib import rc_context

        from ..views.figure_files import save_figure

        png, svg, csv = names = tuple(f"{self.stem}.{end}" for end in ("png", "svg", "csv"))
        with whole(folder / png) as draft:
            save_figure(self.drawn, draft, "png", dpi=180, metadata={"Software": None})
        with rc_context({"svg.hashsalt": self.stem}), whole(folder / svg) as draft:
            save_figure(self.drawn, draft, "svg", metadata={"Date": None, "Creator": None})
        write_text(folder / csv, self.csv)
        return names


@dataclass(frozen=True, kw_only=True)
class Summary(ABC):
    """Findings of a study and the files it wrote; each study derives its class."""

    LEDGER: ClassVar[str] = "claims.json"

    out: Path
    """Folder it wrote."""
    files: tuple[str, ...] = ()
    """Names of what it wrote."""

    @abstractmethod
    def pictures(self) -> Sequence[Callable[[], Picture]]:
        """Functions that draw the figures."""

    @abstractmethod
    def as_json(self) -> dict[str, object]:
        """The content of the ledger."""

    @abstractmethod
    def page(self, figures: str) -> str:
        """The whole page; its figures are HTML."""

    @abstractmethod
    def findings(self) -> list[str]:
        """The first lines of the summary."""

    def tables(self) -> dict[str, str]:
        """Further files, by their names."""
        return {}

    def lines(self) -> list[str]:
        """The summary for a terminal."""
        end = f"{len(self.files)} files in {self.out}; read {self.out / 'index.html'}"
        return [*self.findings(), "", end]


Found = TypeVar("Found", bound=Summary)


def reproduce(
    paper: str,
    find: Callable[[Path, Progress], Found],
    out: str | Path,
    *,
    preset: str | None = None,
    progress: Progress | None = None,
) -> Found:
    """Write every figure as PNG, SVG and CSV, the ledger, and ``index.html``.

    Parameters
    ----------
    paper : str
        Name of the study.
    find : callable
        Gives what the study finds, for the folder and the progress.
    out : path-like
        Folder, made when missing.
    preset : str, optional
        The reading or effort that decides what is drawn.
    progress : callable, optional
        Called with stage, steps done, and steps in all.

    Raises
    ------
    InvalidValue
        A folder that cannot be made.
    """
    folder = prepare_folder(out, paper, preset)
    report = progress or (lambda stage, done, total: None)
    summary = find(folder, report)
    files: list[str] = []
    images: list[tuple[str, str, str, bytes]] = []
    every = summary.pictures()
    for done, draw in enumerate(every):
        report("figures", done, len(every))
        picture = draw()
        png, svg, csv = picture.write(folder)
        files += [png, svg, csv]
        images.append((picture.name, picture.about, picture.note, (folder / svg).read_bytes()))
    report("figures", len(every), len(every))
    report("page", 0, 1)
    ledger = json.dumps(summary.as_json(), ensure_ascii=False, indent=1, allow_nan=False)
    page = summary.page(figures(images))
    texts = {**summary.tables(), summary.LEDGER: ledger + "\n", "index.html": page}
    for name, text in texts.items():
        write_text(folder / name, text)
    report("page", 1, 1)
    return replace(summary, files=(*files, *texts))


@contextmanager
def ignore_ranges() -> Iterator[None]:
    """No warnings of ranges inside: what is beyond the laws stands in the study's own words."""
    import warnings

    from ..errors import RangeWarning

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        yield


FILES = re.compile(
    r"(?:fig[^/]*|share)\.(?:png|svg|csv)|comparison\.(?:csv|json|md)|surfaces|index\.html|"
    r"(?:claims|measurements)\.json"
)
"""What studies of papers write."""
SURFACE = re.compile(r"[^/]+/(?:surface_\d{3,}\.json|\.surface_\d{3,}\.[0-9a-f-]+\.part\.json)")


def prepare_folder(out: str | Path, paper: str, preset: str | None = None) -> Path:
    """A folder for a study, made when missing.

    Parameters
    ----------
    out : path-like
        A new folder, an empty one, or one of the same study.
    paper : str
        Name of the study.
    preset : str, optional
        The reading or effort that decides what is drawn.

    Raises
    ------
    InvalidValue
        It holds another study or anything else, or cannot be made.
    """
    mark = {"command": "reproduce", "paper": paper, "preset": preset}
    return claim_folder(out, mark, files=FILES, unmarked=_unmarked_study)


def _unmarked_study(folder: Path) -> dict[str, object] | None:
    """Nothing, where a ledger of an earlier version lies in a folder, or surfaces of one."""
    ledgers = ("claims.json", "measurements.json", "comparison.json")
    if any("version" in (read_json(folder / name) or {}) for name in ledgers):
        return {}
    kept = folder / "surfaces"
    files = [file.relative_to(kept).as_posix() for file in kept.rglob("*") if file.is_file()]
    alone = {entry.name for entry in folder.iterdir()} <= {MARK, kept.name}
    return {} if alone and files and all(map(SURFACE.fullmatch, files)) else None
