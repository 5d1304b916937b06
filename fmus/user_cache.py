"""Where what is made once is kept for the next time."""

from pathlib import Path


def user_cache() -> Path:
    """`$XDG_CACHE_HOME/driveline-damping` or `~/.cache/driveline-damping`, or what other systems have for it."""
    import platformdirs  # only what makes something asks for it

    return platformdirs.user_cache_path("driveline-damping")
