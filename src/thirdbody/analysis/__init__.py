"""Analysis: many states, what matters, how sure, what would be better."""
