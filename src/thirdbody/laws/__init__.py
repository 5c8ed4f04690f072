"""Contact laws: one file each, one battery of tests for all."""
