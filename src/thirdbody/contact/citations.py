"""Citations computed from the objects in use."""

from __future__ import annotations

from ..laws.base import Law
from ..quantities.carried import takes_units
from .contact import Contact

__all__ = ["cite"]


@takes_units
def cite(contact: Contact) -> str:
    """The works behind a contact, one a line: its laws, outputs and materials.

    Parameters
    ----------
    contact : Contact

    Returns
    -------
    str
        Lines of author, year, journal and DOI, each work once.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=1e-7, R=3e-6))
    >>> print(tb.cite(contact).splitlines()[0])
    Zhao, Maietta, Chang 2000, J. Tribol. 122, 86, doi:10.1115/1.555332
    """
    laws: list[Law] = [contact.asperity_law]
    sources = [contact.surfaces.first.source, contact.surfaces.second.source]
    for particles in contact.populations:
        law = contact.law_of(particles)
        laws.append(law)
        inner = getattr(law, "law", None)
        laws += [inner] if inner is not None else []
        sources.append(particles.material.source)
    laws += contact.outputs
    lines = [law.citation + (f", doi:{law.doi}" if law.doi else "") for law in laws]
    return "\n".join(dict.fromkeys(lines + [text for text in sources if text]))
