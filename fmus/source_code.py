"""What of a source counts: its code, without comments, docstrings, layout and the names of local variables."""

import ast
import re
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from threading import Lock
from typing import Any

_ONE = Lock()
"""CPython 3.11 has one count of depth for all threads that parse (gh-106905)."""

FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)
COMPREHENSIONS = (ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp)
SCOPES = (*FUNCTIONS, *COMPREHENSIONS, ast.Lambda, ast.ClassDef)

NAMED_BY: dict[type[ast.AST], str] = {
    **dict.fromkeys((*FUNCTIONS, ast.ExceptHandler, ast.MatchAs, ast.MatchStar), "name"),
    ast.Name: "id",
    ast.MatchMapping: "rest",
    ast.alias: "asname",
}
"""Attributes in which nodes have the name of a variable."""

OF_NO_MEANING = {"ctx", "kind", "type_comment"}

C_COMMENT = re.compile(r"""/\*.*?\*/|//[^\n]*|("(?:[^"\\]|\\.)*"|'(?:[^'\\]|\\.)*')""", re.DOTALL)
C_TOKEN = re.compile(
    r"""^[ \t]*\#(?:[^\n\\]|\\.)*|"(?:[^"\\]|\\.)*"|'(?:[^'\\]|\\.)*'|\.?\d(?:[eEpP][-+]|[\w.])*|\w+"""
    r"""|->|\+\+|--|<<=?|>>=?|[-+*/%&|^<>=!]=|&&|\|\||\S""",
    re.MULTILINE | re.DOTALL,
)
C_QUALIFIERS = {"const", "static", "struct", "volatile"}
C_STATEMENTS = {"return", "goto", "else", "case", "sizeof", "do"}
MOST_C_DECLARED = 1000
"""Tokens of a declaration that are looked at."""


def syntax_tree(source: str | bytes) -> ast.Module:
    """The tree of a module's source."""
    with _ONE:
        return ast.parse(source)


def code_of(path: Path) -> str:
    """What counts in a file of Python, C or TOML, as a text: the same for two sources that do the same."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".toml":
        return repr(tomllib.loads(text))
    return _python_code(text) if path.suffix == ".py" else _c_code(text)


def _python_code(source: str) -> str:
    out: list[str] = []
    _write(syntax_tree(source), {}, out)
    return "\n".join(out)


def _write(node: ast.AST, names: Mapping[str, str], out: list[str]) -> None:
    """Appends what a node is made of.

    Args:
        names: what stands for each local variable.
    """
    out.append(type(node).__name__)
    inner = _names_inside(node, names, f"{len(out)}.") if isinstance(node, SCOPES) else names
    named_by = NAMED_BY.get(type(node))
    for field, value in ast.iter_fields(node):
        if value is None or value == [] or field in OF_NO_MEANING:
            continue
        out.append(field)
        seen = names if isinstance(node, FUNCTIONS) and field != "body" else inner
        for item in list[Any](value) if isinstance(value, list) else [value]:
            if not isinstance(item, ast.AST):
                is_name = field == named_by or isinstance(node, ast.Nonlocal)
                out.append(repr(seen.get(item, item) if is_name else item))
            elif not (isinstance(item, ast.Expr) and _is_text(item.value)):
                _write(item, seen, out)
    out.append(".")


def _is_text(node: ast.AST) -> bool:
    return isinstance(node, ast.Constant) and isinstance(node.value, str)


def _names_inside(scope: ast.AST, names: Mapping[str, str], prefix: str) -> dict[str, str]:
    """What stands for each local variable within a function, a comprehension or a class, whose own are attributes."""
    within: Any = getattr(scope, "generators", None) or getattr(scope, "body", [])
    bound = dict.fromkeys(_bound(within)) if isinstance(within, list) else {}
    arguments = {each.arg for each in ast.walk(scope) if isinstance(each, ast.arg)}
    outer = {name: of for name, of in names.items() if name not in bound and name not in arguments}
    if isinstance(scope, ast.ClassDef):
        return outer
    shared = {name for each in ast.walk(scope) if isinstance(each, ast.Global | ast.Nonlocal) for name in each.names}
    own = (name for name in bound if name not in arguments and name not in shared)
    kept = {name: of for name, of in names.items() if name in shared}
    return outer | kept | {name: f"{prefix}{k}" for k, name in enumerate(own)}


def _bound(nodes: list[Any]) -> Iterator[str]:
    """Names that nodes give values to, in their order, without those inside functions and classes in them."""
    for node in nodes:
        name = getattr(node, NAMED_BY.get(type(node), ""), None)
        if name and not (isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load)):
            yield name
        if not isinstance(node, SCOPES):
            yield from _bound(list(ast.iter_child_nodes(node)))


def _c_code(source: str) -> str:
    tokens = C_TOKEN.findall(C_COMMENT.sub(lambda found: found[1] or " ", source))
    out: list[str] = []
    names: dict[str, str] = {}
    depth, in_function, before = 0, False, ";"
    for k, token in enumerate(tokens):
        if depth == 0:
            in_function, names = before == ")" and token == "{", {}
        depth += (token == "{") - (token == "}")
        if in_function and depth and before in {";", "{", "}", "("}:
            names |= {name: f"local {k}.{place}" for place, name in enumerate(_c_declared(tokens, k))}
        text = " ".join(token.split()) if token.lstrip().startswith("#") else token
        out.append(text if before in {".", "->"} else names.get(text, text))
        before = token
    return "\n".join(out)


def _c_declared(tokens: list[str], k: int) -> Iterator[str]:
    """Variables that a statement of a function declares, if it does; it begins with token k."""
    while tokens[k] in C_QUALIFIERS:
        k += 1
    pointed = [token for token in tokens[k + 1 : k + MOST_C_DECLARED] if token != "*"]
    is_type = tokens[k].isidentifier() and tokens[k] not in C_STATEMENTS
    if not (is_type and pointed[0].isidentifier() and pointed[1] in {"=", ";", ",", "["}):
        return
    depth, before = 0, ","
    for token in pointed:
        if before == "," and depth == 0:
            yield token
        depth += (token in {"(", "[", "{"}) - (token in {")", "]", "}"})
        if depth < 0 or token == ";":
            return
        before = token
