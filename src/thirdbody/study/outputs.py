"""The table [outputs]: what else the states of the contact tell, a table for each output."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..effects import REGISTRY
from ..errors import Note
from ..quantities.say import value_of
from ..systems.bodies import Flat
from .reader import NOTHING, Key, Reader, Table, get, table_of

if TYPE_CHECKING:
    import numpy as np

    from ..contact.contact import Contact
    from ..contact.output import AbstractOutput
    from ..systems.bodies import Body

__all__ = ["OUTPUTS", "on_area"]


def _outputs(reader: Reader, path: str, data: object) -> object:
    """Every output that the file names."""
    keys = {name: table_of(kind, kind.title) for name, kind in REGISTRY.items()}
    return reader.table(path, data, keys, lambda values: tuple(values.values()))


def on_area(
    contact: Contact, body: Body | None, forces: np.ndarray | None, data: object
) -> tuple[Contact, list[str]]:
    """The contact whose outputs are of the area of the body where the file gives none, and notes.

    A flat body has one area; curved ones have Hertz's, which is one where there is one force. The
    probability of closing is asked of the area that carries, which Hertz's is not on rough bodies.
    """
    area: float | None = None
    if isinstance(body, Flat):
        area = body.area
    elif body is not None and forces is not None and len(forces) == 1:
        area = float(body.hertz(forces[0], contact.E_ss).area)
    out: list[AbstractOutput] = []
    notes: list[str] = []
    output: Any
    for output in contact.outputs:
        unsaid = "A_n" in output.__dataclass_fields__ and get(get(data, output.name), "A_n") is None
        closes = unsaid and output.A_n is None
        if unsaid and area is not None and not (closes and not isinstance(body, Flat)):
            output = output.replace(A_n=area)
        elif closes and (name := _closing_column(output)):
            of_body = "" if body is None else ", which is not Hertz's where bodies are rough"
            what = (
                f"outputs.{output.name}: {name} is not known without A_n, the area of one contact"
                f"{of_body}; give outputs.{output.name}.A_n"
            )
            notes.append(Note(what, code=f"{output.name}.area.closed"))
        elif unsaid and not closes and body is not None and forces is not None:
            what = (
                f"outputs.{output.name}: the largest is of A_n = {value_of(output.A_n, 'm^2')}, "
                "not of the contact of the bodies, which differs among the forces; give "
                f"outputs.{output.name}.A_n"
            )
            notes.append(Note(what, code=f"{output.name}.area.largest"))
        out.append(output)
    same = tuple(out) == contact.outputs
    return (contact if same else contact.replace(outputs=tuple(out))), notes


def _closing_column(output: AbstractOutput) -> str:
    """The column that is the probability of closing; empty where there is none."""
    return next((name for name in output.columns if name.endswith("_closed")), "")


OUTPUTS = Table(name="outputs", key=Key(schema=NOTHING, table=_outputs))
