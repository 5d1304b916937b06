"""Pages that need nothing else: one kit of figures and tables for reports and the explorer."""
