"""Tables of studies on the terminal."""

from rich.table import Table as Printed

from toolground.plain_text import printed
from toolground.tables import print_table

from .study import Table, number


def show(name: str, table: Table) -> None:
    """Prints a table."""
    headings = (f"{column.name}, {printed(column.unit)}" if column.unit else column.name for column in table.columns)
    shown = Printed(table.label, *headings, title=name, title_justify="left")
    for row, cells in table.rows.items():
        shown.add_row(row, *(number(cell, column) for cell, column in zip(cells, table.columns, strict=True)))
    print_table(shown)
