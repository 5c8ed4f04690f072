"""One file for each command, with a function ``command``; the order is that of the help."""

COMMANDS = (
    "new",
    "solve",
    "sweep",
    "film",
    "probability",
    "plate",
    "life",
    "explicit",
    "assess",
    "design",
    "report",
    "compare",
    "table",
    "surface",
    "app",
    "reproduce",
    "laws",
    "outputs",
    "materials",
    "schema",
)
