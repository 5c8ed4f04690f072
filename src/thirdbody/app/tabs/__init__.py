"""One file for each tab, with its title and a function ``build``; the order is that of the page."""

GROUPS = {
    "Contact": ("interface", "curves", "mode_map", "outputs"),
    "Oil and dust": ("dust", "film"),
    "Questions": ("connector", "plate", "life"),
    "How sure": ("error_bars", "compare", "explicit"),
    "What to do": ("surface", "before_after", "design", "take_away"),
}
"""Tabs by what they are for."""
LINES = ("How sure",)
"""Groups with which a line of tabs begins where one line does not hold all."""
TABS = tuple(name for names in GROUPS.values() for name in names)
