"""Studies: one module per paper, with its inputs, its figures and a ledger of what it states."""

PAPERS = (
    "horng2022",
    "ghaednia2013",
    "ghaednia2014",
    "wu2017",
    "frontiers2024",
    "measurements",
    "life",
    "explicit",
)
"""Every study, by the name of its module: what ``thirdbody reproduce`` takes."""
