"""A contact: laws integrated over populations, at a given separation."""
