"""Views: figures, pages and words for what was found."""
