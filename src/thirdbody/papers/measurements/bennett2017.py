"""A printed model of the surface of the contact-mechanics challenge on silicone."""

from __future__ import annotations

from .row import ABSTRACT, CHOSEN, Input, Row, statement

__all__ = ["ROW"]

ROW = Row(
    "bennett2017",
    "The surface of the contact-mechanics challenge, printed",
    "Bennett et al. 2017, Tribol. Lett., Contact Measurements of Randomly Rough Surfaces",
    "The surface of the challenge of 2015 (arXiv:1512.02403) a thousand times larger in acrylic "
    "glass, on silicone of 14 kPa to 2.1 MPa; contact seen by frustrated total reflection.",
    (Input("gradient and curvature of the surface", "not in what could be read", CHOSEN),),
    (
        statement(
            "area",
            "From a pressure below 0.001 E to one above E the real area grows from below 0.1 % to "
            "over 60 %",
            ABSTRACT,
            "real area",
            {},
            lambda: None,
            undecided="the prediction needs the rms gradient of the surface, which the abstracts "
            "do not give; elastic sums are known to be low for spectra as broad (see the row on "
            "boundary elements)",
        ),
    ),
    "Nothing yet.",
)
