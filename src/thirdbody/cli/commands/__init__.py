"""One file for each command, with a function ``command``; the order is that of the help."""

COMMANDS = (
    "solve",
    "sweep",
    "assess",
    "compare",
    "table",
    "surface",
    "reproduce",
    "laws",
    "materials",
)
