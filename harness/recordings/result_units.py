"""The units of results of ours, which stand in the JSON file beside them."""

import json
from pathlib import Path


def units_beside(path: Path) -> dict[str, str]:
    """Unit by column of a file of results; nothing if no record beside it tells of this file.

    The record of several files has the beginning of their names, as trip.json has of trip_off.csv.
    """
    stem = path.stem
    while stem:
        record = path.with_name(f"{stem}.json")
        try:
            content = json.loads(record.read_text(encoding="utf-8"))
            if path.name in content["files"]:
                return {str(name): str(unit) for name, unit in content["units"].items()}
        except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
            pass  # there is none, or it is something else
        stem = stem.rpartition("_")[0]
    return {}
