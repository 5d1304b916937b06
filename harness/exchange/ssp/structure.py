"""The system structure description (SSD): the FMUs of the loop, how they are connected, and their picture.

Some tools know less than the standard. What is written for them:
- libcosim: connections are between components alone, every element has a source, the step stands in an annotation,
  and values belong to components;
- FMPy: every input that is declared is connected;
- OMSimulator: the type of a component is said even where it is the usual one, the step stands in an annotation of the
  system, and there is neither a signal dictionary nor a geometry of the system, at which its command line stops.
"""

from collections.abc import Mapping

from fmpy.model_description import ModelVariable

from fmuloop.interface import unit_of
from fmuloop.system import Connection
from fmuloop.wiring import Fit

from ...loop.places import STEP_SIZE
from .layout import Layout, Place
from .variables import as_it_is, conversion, outputs, their_name, typed_element, units, version
from .xml import Element, document, element

OSP, OMS = "com.opensimulationplatform", "org.openmodelica"
"""Owners of the annotations that libcosim and OMSimulator read."""


def structure(name: str, description: str, tool: str, fitted: Fit, sets: Mapping[str, str], stop_time: float) -> bytes:
    """The file of a system structure description.

    Args:
        name: of the variant.
        tool: that made it.
        sets: instance -> file of its parameters.
        stop_time: in s.
    """
    shown = _connectors(fitted)
    layout = Layout(list(fitted.interfaces), fitted.system.connections)
    system = element(
        "ssd:System",
        {"name": "loop", "description": description},
        [
            element("ssd:Elements", children=[_component(fitted, i, shown, sets, layout) for i in fitted.interfaces]),
            element("ssd:Connections", children=[_connection(fitted, c, layout) for c in fitted.system.connections]),
            _annotation(OMS, "oms:Annotations", element("oms:SimulationInformation", children=[_oms_step()])),
        ],
    )
    return document(
        element(
            "ssd:SystemStructureDescription",
            {"version": version(fitted), "name": name, "description": description, "generationTool": tool},
            [system, *units("ssd", fitted, map(unit_of, shown.values())), _experiment(stop_time)],
        )
    )


def _connectors(fitted: Fit) -> dict[str, ModelVariable]:
    """All outputs, and the inputs that are connected, as their FMUs have them."""
    targets = [connection.target for connection in fitted.system.connections]
    return {name: as_it_is(fitted, name) for name in (*outputs(fitted), *targets)}


def _component(
    fitted: Fit, instance: str, shown: Mapping[str, ModelVariable], sets: Mapping[str, str], layout: Layout
) -> Element:
    interface = fitted.interfaces[instance]
    connectors = [
        _connector(their_name(fitted.system, name), name, variable, interface.fmi, layout.places.get(name))
        for name, variable in shown.items()
        if name.partition(".")[0] == instance
    ]
    binding = element("ssd:ParameterBinding", {"source": sets[instance]})
    return element(
        "ssd:Component",
        {
            "name": instance,
            "type": "application/x-fmu-sharedlibrary",
            "source": f"resources/{interface.path.name}",
            "implementation": "CoSimulation",
            "description": interface.description.description or interface.path.stem,
        },
        [
            element("ssd:Connectors", children=connectors),
            element("ssd:ElementGeometry", layout.boxes[instance]._asdict()),
            element("ssd:ParameterBindings", children=[binding]),
        ],
    )


def _connector(theirs: str, name: str, variable: ModelVariable, fmi: int, place: Place | None) -> Element:
    connector = element(
        "ssd:Connector",
        {"name": theirs, "kind": variable.causality, "description": variable.description or name},
        [typed_element("ssc", str(variable.type), fmi, unit_of(variable))],
    )
    if place is not None:
        connector.append(element("ssd:ConnectorGeometry", place._asdict()))
    return connector


def _connection(fitted: Fit, connection: Connection, layout: Layout) -> Element:
    ends = {}
    for end, name in {"start": connection.source, "end": connection.target}.items():
        ends[f"{end}Element"] = name.partition(".")[0]
        ends[f"{end}Connector"] = their_name(fitted.system, name)
    factor = conversion(fitted, connection)
    line = element("ssd:Connection", ends | ({"suppressUnitConversion": True} if factor != 1.0 else {}))
    if factor != 1.0:
        line.append(element("ssc:LinearTransformation", {"factor": factor}))
    corners = layout.corners[connection.source, connection.target]
    along = {f"points{axis}": " ".join(repr(corner[k]) for corner in corners) for k, axis in enumerate("XY")}
    line.append(element("ssd:ConnectionGeometry", along))
    return line


def _oms_step() -> Element:
    return element("oms:FixedStepMaster", {"description": "oms-ma", "stepSize": STEP_SIZE, "relativeTolerance": 1e-4})


def _experiment(stop_time: float) -> Element:
    step = element("osp:FixedStepAlgorithm", {"baseStepSize": STEP_SIZE})
    times = {"startTime": 0.0, "stopTime": stop_time}
    return element("ssd:DefaultExperiment", times, [_annotation(OSP, "osp:Algorithm", step)])


def _annotation(owner: str, root: str, content: Element) -> Element:
    annotation = element("ssc:Annotation", {"type": owner}, [element(root, children=[content])])
    return element("ssd:Annotations", children=[annotation])
