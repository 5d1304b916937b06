"""C statements for a traced function."""

import sys
from collections import Counter
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from .arithmetic import TRUTH_VALUES, Graph, Guard, Node


class Precision(NamedTuple):
    """How C writes a real number: its type, the endings of constants and of the functions of math.h, the
    largest finite number (larger constants become it, so that a test for finite numbers stays one)."""

    real: str
    constant: str
    function: str
    largest: float


DOUBLE = Precision("double", "", "", sys.float_info.max)
SINGLE = Precision("float", "f", "f", (2.0 - 2.0**-23) * 2.0**127)


def constant(value: float, precision: Precision) -> str:
    """A number as C writes it."""
    return repr(min(max(value, -precision.largest), precision.largest)) + precision.constant


LOOPED = 8
"""Elements of an array from which on a loop assigns them."""

LONGEST = 80
"""Characters of an expression; longer ones are given a name."""

SUM, PRODUCT, SIGN, ATOM = 5, 6, 7, 8
CHOICE, OR, AND, COMPARISON = 1, 2, 3, 4
INFIX = {
    "ADD": ("+", SUM),
    "SUB": ("-", SUM),
    "MUL": ("*", PRODUCT),
    "DIV": ("/", PRODUCT),
    "LT": ("<", COMPARISON),
    "LE": ("<=", COMPARISON),
    "EQ": ("==", COMPARISON),
    "NE": ("!=", COMPARISON),
    "AND": ("&&", AND),
    "OR": ("||", OR),
}
CALLED = {"FABS": "fabs", "FMIN": "fmin", "FMAX": "fmax", "CONSTPOW": "pow"}
"""C functions whose names are not those of the operations."""


class Text(NamedTuple):
    """An expression in C and the kind of its outermost operator. Between operators of different kinds are parentheses,
    even where C needs none (MISRA C, rule 12.1)."""

    text: str
    strength: int = ATOM

    def within(self, strength: int) -> str:
        """Itself as an operand, in parentheses unless it is a chain of operators of that strength or needs none."""
        return self.text if self.strength == strength or self.strength >= max(strength, SIGN) else f"({self.text})"


def _place(name: str, further: int = 0) -> tuple[str, int]:
    """The array of a number in C, and its place there or so many places further."""
    array, _, place = name.rpartition("[")
    return (array, int(place[:-1]) + further) if place[:-1].isdecimal() else (name, further)


def _counted(name: str) -> str:
    """The element of an array that is `k` places after one."""
    array, place = _place(name)
    return f"{array}[k + {place}]" if place else f"{array}[k]"


class Statements:
    """Writes the operations of a graph in the order in which the outputs need them.

    Args:
        outputs: for each element of the output what is assigned to.
    """

    LEAST = 1
    """Operations that a branch saves."""

    def __init__(self, graph: Graph, outputs: Sequence[str], precision: Precision = DOUBLE) -> None:
        self._graph = graph
        self._precision = precision
        self._guards = graph.guards(self.LEAST)
        self._uses = Counter(graph.outputs.values())
        self._uses.update({k: len(users) for k, users in graph.users().items()})
        self._conditions = {condition for guards in self._guards.values() for condition, _ in guards}
        self._named = 0
        self._indent = "    "
        self._texts: dict[int, Text] = {}
        self.lines: list[str] = []
        elements = sorted(graph.outputs)
        while elements:
            count, moves = self._loop(elements, outputs)
            name, k = outputs[elements[0]], graph.outputs[elements[0]]
            self._need(k, frozenset())
            if count > 1:
                value = _counted(self._input(k)) if moves else self._number(k).text
                self.lines += [
                    f"    for (int k = 0; k < {count}; k++) {{",
                    f"        {_counted(name)} = {value};",
                    "    }",
                ]
            else:
                self._line(f"{name} = {self._number(k).text};")
            del elements[:count]

    def _loop(self, elements: Sequence[int], outputs: Sequence[str]) -> tuple[int, bool]:
        """How many of the elements of the output a loop can assign, 1 if it is not worth one: they follow each other
        in an array. Their values do so too, in an array of the input, or else are one value."""
        first = self._graph.outputs[elements[0]]
        for moves in (False, True):
            count = 0
            for element in elements:
                k = self._graph.outputs[element]
                same = _place(self._input(k)) == _place(self._input(first), count) if moves else k == first
                if not (same and _place(outputs[element]) == _place(outputs[elements[0]], count)):
                    break
                count += 1
            if count >= LOOPED:
                return count, moves
        return 1, False

    def _input(self, k: int) -> str:
        """What C calls a node of the input; nothing for others."""
        node = self._graph.nodes[k]
        return self._graph.inputs[node.place[0]][node.place[1]] if node.operation == "INPUT" else ""

    @staticmethod
    def is_not_zero(number: str) -> str:
        """The C of it."""
        return f"{number} != 0"

    def _line(self, text: str) -> None:
        self.lines.append(self._indent + text)

    def _need(self, k: int, context: frozenset[Guard]) -> None:
        """Makes the text of a node available, and with it those of the nodes that it needs."""
        if k in self._texts:
            return
        taken = self._taken(k, context)
        if taken != k:
            self._need(taken, context)
            self._texts[k] = self._number(taken)
            return
        node = self._graph.nodes[k]
        if node.operation == "CHOICE" and node.operands[0] in self._conditions:
            self._branch(k, context)
            return
        for operand in node.operands:
            self._need(operand, context)
        text = self._expression(node)
        if node.operands and (self._uses[k] > 1 or len(text.text) > LONGEST):
            text = self._name(text, self._type(node))
        self._texts[k] = text

    def _taken(self, k: int, context: frozenset[Guard]) -> int:
        """The node itself, or, if it is a choice that has been made, what was chosen."""
        node = self._graph.nodes[k]
        while node.operation == "CHOICE":
            sides = [place for place in (1, 2) if (node.operands[0], place == 1) in context]
            if not sides:
                break
            k = node.operands[sides[0]]
            node = self._graph.nodes[k]
        return k

    def _type(self, node: Node) -> str:
        if node.operation in TRUTH_VALUES:
            return "bool"
        return "int" if node.operation == "INDEX" else self._precision.real

    def _name(self, text: Text, kind: str) -> Text:
        self._named += 1
        self._line(f"const {kind} a{self._named} = {text.text};")
        return Text(f"a{self._named}")

    def _branch(self, k: int, context: frozenset[Guard]) -> None:
        """An `if` for a choice, and for all others with the same condition that can be made there."""
        condition = self._graph.nodes[k].operands[0]
        self._need(condition, context)
        chosen: list[int] = []
        for choice in [k, *self._alike(k, context)]:
            around = self._around(choice, context)
            if choice not in self._texts and not self._depends(around, chosen):
                for operand in around:
                    self._need(operand, context)
                chosen.append(choice)
        names = [f"a{self._named + n}" for n in range(1, len(chosen) + 1)]
        self._named += len(chosen)
        for name in names:
            self._line(f"{self._precision.real} {name};")
        self._sides(condition, chosen, names, context)
        self._texts |= {choice: Text(name) for choice, name in zip(chosen, names, strict=True)}

    def _sides(self, condition: int, chosen: list[int], names: list[str], context: frozenset[Guard]) -> None:
        for opening, place in ((f"if ({self._truth(condition).text}) {{", 1), ("} else {", 2)):
            self._line(opening)
            self._side(condition, place, chosen, names, context)
        self._line("}")

    def _side(self, condition: int, place: int, chosen: list[int], names: list[str], context: frozenset[Guard]) -> None:
        """The statements of one side; what is named there is unknown elsewhere."""
        texts, indent = dict(self._texts), self._indent
        self._indent += "    "
        for choice, name in zip(chosen, names, strict=True):
            value = self._graph.nodes[choice].operands[place]
            self._need(value, context | {(condition, place == 1)})
            self._line(f"{name} = {self._side_value(condition, place, name, value)};")
        self._texts, self._indent = texts, indent

    def _side_value(self, condition: int, place: int, name: str, value: int) -> str:
        """What the name of a choice gets on one side."""
        return self._number(value).text

    def _alike(self, k: int, context: frozenset[Guard]) -> Iterable[int]:
        """Other choices with the condition of choice k that are needed where it is."""
        condition, guards = self._graph.nodes[k].operands[0], self._guards[k]
        if not guards <= context:
            return
        for other, node in enumerate(self._graph.nodes):
            alike = node.operation == "CHOICE" and node.operands[0] == condition
            if alike and other != k and self._guards.get(other) == guards:
                yield other

    def _around(self, choice: int, context: frozenset[Guard]) -> list[int]:
        """Nodes outside both sides of a choice that are needed inside."""
        node = self._graph.nodes[choice]
        outside: list[int] = []
        seen: set[int] = set()
        for place in (1, 2):
            inside = context | {(node.operands[0], place == 1)}
            waiting = [node.operands[place]]
            while waiting:
                k = self._taken(waiting.pop(), inside)
                if k in seen:
                    continue
                seen.add(k)
                if self._guards[k] >= inside:
                    waiting += self._graph.nodes[k].operands
                else:
                    outside.append(k)
        return sorted(outside)

    def _depends(self, nodes: Iterable[int], on: list[int]) -> bool:
        """Whether one of the nodes, as far as they are not available, needs a node of `on`."""
        waiting, seen = list(nodes), set[int]()
        while waiting and on:
            k = waiting.pop()
            if k in on:
                return True
            if k not in seen and k not in self._texts:
                seen.add(k)
                waiting += self._graph.nodes[k].operands
        return False

    def _number(self, k: int) -> Text:
        text = self._texts[k]
        if self._graph.nodes[k].operation not in TRUTH_VALUES:
            return text
        return Text(f"{text.within(SIGN)} ? {self._constant(1.0)} : {self._constant(0.0)}", CHOICE)

    def _truth(self, k: int) -> Text:
        text = self._texts[k]
        if self._graph.nodes[k].operation in TRUTH_VALUES:
            return text
        return Text(f"{text.within(SIGN)} != {self._constant(0.0)}", COMPARISON)

    def _constant(self, value: float) -> str:
        return constant(value, self._precision)

    def _index(self, position: Text, most: int) -> Text:
        """The whole part of a position; of one that is not a number it is 0, as every comparison with that fails."""
        text = position.within(ATOM)
        beyond = f"({self._constant(float(most))} <= {text})"
        within = f"({self._constant(1.0)} <= {text})"
        return Text(f"{beyond} ? {most} : ({within} ? (int){text} : 0)", CHOICE)

    def _expression(self, node: Node) -> Text:
        operation, operands = node.operation, node.operands
        match operation:
            case "INPUT":
                vector, element = node.place
                return Text(self._graph.inputs[vector][element])
            case "CONSTANT":
                return Text(self._constant(node.number), SIGN if node.number < 0.0 else ATOM)
            case "CHOICE":
                condition, value, otherwise = self._truth(operands[0]), *map(self._number, operands[1:])
                return Text(f"{condition.within(SIGN)} ? {value.within(SIGN)} : {otherwise.within(SIGN)}", CHOICE)
            case "INDEX":
                return self._index(self._number(operands[0]), int(node.number))
            case "WHOLE":
                return Text(f"({self._precision.real}){self._number(operands[0]).within(ATOM)}", SIGN)
            case "ELEMENT":
                vector, element = node.place
                array, _, place = self._graph.inputs[vector][element].rpartition("[")
                further = "" if place == "0]" else f" + {place.removesuffix(']')}"
                return Text(f"{array}[{self._texts[operands[0]].text}{further}]")
            case "NOT":
                return Text(f"!{self._truth(operands[0]).within(ATOM)}", SIGN)
            case "AND" | "OR":
                sign, strength = INFIX[operation]
                return Text(f" {sign} ".join(self._truth(k).within(SIGN) for k in operands), strength)
        numbers = [self._number(k) for k in operands]
        if operation in INFIX:
            sign, strength = INFIX[operation]
            return Text(f"{numbers[0].within(strength)} {sign} {numbers[1].within(SIGN)}", strength)
        match operation:
            case "NEG":
                return Text(f"-{numbers[0].within(ATOM)}", SIGN)
            case "SQ":
                return Text(f"square({numbers[0].text})")
            case "TWICE":
                return Text(f"{self._constant(2.0)} * {numbers[0].within(SIGN)}", PRODUCT)
            case "INV":
                return Text(f"{self._constant(1.0)} / {numbers[0].within(SIGN)}", PRODUCT)
            case "FMOD":
                return Text(f"modulo({', '.join(text.text for text in numbers)})")
            case "SIGN":
                return Text(f"sign_of({numbers[0].text})")
        name = CALLED.get(operation, operation.lower()) + self._precision.function
        return Text(f"{name}({', '.join(text.text for text in numbers)})")
