"""Systems around a contact: films, oil, bodies, waves, bearings."""
