"""Design and analysis with the models themselves; nothing else in the harness imports them."""
