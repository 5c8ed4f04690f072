"""``thirdbody assess``: how sure the answer is, on one page."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from ...errors import InvalidValue, Mistake, Problem
from ...quantities.tables import WordTable
from ..options import AsJson, Force, KeepFile, Settings, argument, option, read_study
from ..show import terminal
from ..streams import STDOUT, TableFiles, print_json, tell_written, warn

__all__ = ["command"]


@dataclass(frozen=True, kw_only=True)
class Options:
    """Options of the command."""

    study: Path = argument(
        "A study file; its table [uncertainty] says what scatters.", "STUDY.toml"
    )
    as_json: AsJson = False
    html: Path | None = option(
        "--html", "Write the page with figures, one file, e.g. a.html.", "FILE"
    )
    force: Force = False
    keep: KeepFile = None
    settings: Settings = None


def command(options: Options) -> None:
    """How sure the answer of a study is, and what would change it.

    One page: the mode at each operating load, its odds, margins and the inputs that matter; of a
    study with [life.uncertainty], how sure the answer of `thirdbody life` is.
    """
    from ...quantities.files import write_text
    from ...study.analyses import assess_study
    from ...study.film import note_without_oil
    from ...study.life_uncertainty import asks_for_bands
    from ...views.assess_page import page
    from ..own_files import need_places

    if options.keep is not None and not asks_for_bands(options.study, options.settings or ()):
        raise InvalidValue(
            Problem(
                "--keep",
                "keeps the histories of [life.uncertainty], and the study has none",
                code=Mistake.MISSING,
            )
        )

    if asks_for_bands(options.study, options.settings or ()):
        _assess_life(options)
        return
    study = read_study(options.study, options.settings, writes=[options.html])
    if study.life is not None:
        warn(
            "[life] is not assessed without [life.uncertainty]: the answer is of the contact alone"
        )
    need_places([(options.html, "page")], force=options.force)
    if study.film is not None:
        warn(note_without_oil("this page will be"))  # before the work, which is long
    answer = assess_study(study, progress=True)
    shown = replace(answer, title=study.heading) if study.settings else answer
    if options.html is not None:
        write_text(options.html, page(shown))
        tell_written(options.html)
    if options.as_json:
        print_json(answer.to_dict())
    else:
        terminal().print(shown.page("--json or --html FILE has all of it"))


def _assess_life(options: Options) -> None:
    """How sure the answer of an oil, or of a dry contact, over time is."""
    from ...study.life_assessment import assess_life
    from ...study.run_life import load_life
    from ...views import life_bands_words as words
    from ..answers import give_answer, read_question
    from ..interrupt import resumable

    if options.html is not None:
        rule = "writes no page on [life.uncertainty]; thirdbody report writes one with it"
        raise InvalidValue(Problem("--html", rule, code=Mistake.MISSING))
    files = TableFiles(json=STDOUT if options.as_json else None)
    question = read_question(load_life, options.study, options.settings, files, force=options.force)
    with resumable("assess", options.keep):
        result = assess_life(question, progress=True, keep=options.keep)
    give_answer(
        result,
        files,
        settings=options.settings,
        answer=words.answer(result),
        table=WordTable(words.HEADS, words.rows(result), words.MEANS),
        last=words.last_words(result),
    )
