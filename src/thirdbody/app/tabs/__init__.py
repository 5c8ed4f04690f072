"""One file for each tab, with its title and a function ``build``; the order is that of the page."""

TABS = (
    "interface",
    "curves",
    "mode_map",
    "compare",
    "surface",
    "dust",
    "error_bars",
    "outputs",
    "film",
    "connector",
    "plate",
    "explicit",
    "design",
    "take_away",
)
