"""The gallery: every figure of the studies with the command that makes it anew."""

from docs.studies import data_file
from docs.studies.study import STUDIES, study

PAGE = "gallery.md"


def page() -> str:
    """The page in Markdown; its figures are drawn as those of other pages are."""
    lines = ["# Gallery", "", "Every figure of the studies, and the command that makes its numbers anew."]
    for name in STUDIES:
        if data_file.file_of(name).is_file() and (figures := data_file.read(name).measured.figures):
            lines += ["", f"## {name}", "", f"{study(name).purpose}: `python -m docs.studies {name}`"]
            for figure in figures:
                lines += ["", f"[figure: {name}/{figure}](studies/data/{name}.json)"]
    return "\n".join(lines) + "\n"
