"""Studies: one module per paper, with its inputs, its figures and a ledger of what it states."""
