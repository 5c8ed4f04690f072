"""The compiled engine: the same states, millions of them."""
