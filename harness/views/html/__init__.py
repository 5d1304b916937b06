"""The report as one page of HTML: its figures, tables and text."""
