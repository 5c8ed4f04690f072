"""One particle squeezed between two surfaces, at any squeeze: plastic flow followed in time."""
