"""What the two builds of a block say of themselves; everything else is the same in both."""

from dataclasses import dataclass, field


@dataclass(frozen=True)
class BuildKind:
    """One way to build FMUs.

    Attributes:
        capabilities: attributes of the element CoSimulation that are not the same in every build.
        model_exchange: attributes of the element ModelExchange that are not the same in every build; none: there is
            no such element.
        log_categories: names and descriptions.
        needs: what the host must have, as HTML.
        external: what it needs besides itself, as plain text; empty for nothing.
        inputs: how inputs are taken over a communication step, as HTML.
        source_files: C files in the folder sources that together are the FMU.
        version: of FMI.
        picture: path of the picture in the archive, where that version has it.
        has_terminal: it sends its frames over a bus.
        tool: the library with whose help it was made; empty for none.
    """

    capabilities: dict[str, str]
    log_categories: dict[str, str]
    needs: str
    external: str = ""
    model_exchange: dict[str, str] = field(default_factory=dict[str, str])
    inputs: str = "Inputs are held over a communication step."
    source_files: tuple[str, ...] = ()
    version: str = "2.0"
    picture: str = "model.png"
    has_terminal: bool = False
    tool: str = ""
