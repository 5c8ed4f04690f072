"""Design: inputs that make an objective best under limits."""
