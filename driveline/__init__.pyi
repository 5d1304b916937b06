# Run: one run of the closed loop, or many
from .harness.simulation.simulate import simulate as simulate
from .harness.simulation.simulate import planned as planned
from .harness.loop.settings import Settings as Settings
from .harness.metrics.evaluate import evaluate as evaluate
from fmuloop.many_runs import run_many as run_many
from fmuloop.many_runs import many as many
from fmuloop.runs import kept_loaded as kept_loaded
from .harness.loop.built_fmus import build_missing as build_missing
from fmuloop.results import Results as Results
from .harness.metrics.run_metrics import Metrics as Metrics
from .harness.metrics.notebook_table import frame as frame
from .harness.views.signals_file import write_signals as write_signals
from .harness.views.run_figure import plot as plot

# Manoeuvres: what driver, brakes and road do
from .harness.manoeuvres.catalogue import MANOEUVRES as MANOEUVRES
from .harness.manoeuvres.manoeuvre import Manoeuvre as Manoeuvre
from .harness.manoeuvres.manoeuvre_file import read_manoeuvre as read_manoeuvre
from .harness.manoeuvres.composed import composed as composed
from .harness.manoeuvres.parts import constant as constant
from .harness.manoeuvres.parts import points as points
from .harness.manoeuvres.parts import step as step
from .harness.manoeuvres.parts import ramp as ramp
from .harness.manoeuvres.parts import pulse as pulse
from .harness.manoeuvres.parts import sine as sine
from .harness.manoeuvres.parts import chirp as chirp
from .harness.manoeuvres.parts import prbs as prbs

# Studies: what many runs say
from .harness.studies.compare.side_by_side import compare as compare
from .harness.studies.drives.recorded_drive import replay as replay
from .harness.studies.drives.replay import Ride as Ride
from .harness.studies.margins.whole_loop import analyse as analyse
from .harness.studies.margins.loop_analysis import Analysis as Analysis

# Car and controller: from a vehicle to gains
from .fmus.building.parameter_files import read_vehicle as read_vehicle
from .fmus.building.parameter_files import read_parameters as read_parameters
from .fmus.building.parameter_files import read_files as read_files
from .fmus.building.car_entries import car as car
from .harness.design.loop_parameters import loop_parameters as loop_parameters
from .harness.design.loop_parameters import controller_parameters as controller_parameters
from .harness.design.design import design as design
from .harness.design.design_weights import Weights as Weights
from .harness.design.redesign import softened as softened
from .harness.design.design import gains_file as gains_file
from .harness.design.search.cost_evaluation import CostEvaluation as CostEvaluation

# Recordings: what was measured, and what it says of the car
from driverecords.measurement import read_measurement as read_measurement
from driverecords.measurement import Measurement as Measurement
from driverecords.drive import read_drive as read_drive
from driverecords.drive import Drive as Drive
from .harness.identification.prior_knowledge import identify as identify
from .harness.identification.identify import Identified as Identified
from .harness.identification.car_file import identified_lines as identified_lines
from .harness.identification.car_file import identified_car as identified_car
from .harness.identification.car_file import vehicle_file as vehicle_file

# FMUs: those of the project, and blocks of your own
from .fmus.building.builds import build_fmus as build_fmus
from fmublocks.fmu import Fmu as Fmu
from fmublocks.block.types import ContinuousBlock as ContinuousBlock
from fmublocks.block.types import SampledBlock as SampledBlock
from fmublocks.block.declaration import Real as Real
from fmublocks.block.declaration import Integer as Integer
from fmublocks.block.declaration import Boolean as Boolean
from fmublocks.block import operators as operators
from .models.physics import plant as plant
from .models.physics import vehicle as vehicle
from .models.controller.supervised_controller import supervised as supervised
from .models.controller.interfaces import Estimator as Estimator
from .models.controller.interfaces import Law as Law
from .models.controller.interfaces import Motion as Motion
from .models.controller.interfaces import Addition as Addition
from .models.controller import torque_estimator as torque_estimator
from .models.comparators import measured_speeds as measured_speeds
from .models.controller.damping_law import washed_out as washed_out

# Systems: the loop with other schemes and limits, or a system of your own
from fmuloop.system import Scheme as Scheme
from fmuloop.limits import Limits as Limits
from fmuloop.system import System as System
from fmuloop.system import Connection as Connection
from fmuloop.system import Port as Port
from fmuloop.experiment import Experiment as Experiment
from fmuloop.loading import loaded as loaded
from fmuloop.master import Loop as Loop

# Errors: what can be mended; the message says what is wrong and what is allowed
from .fmus.errors import DrivelineError as DrivelineError
from fmuloop.errors import WiringError as WiringError
from fmuloop.errors import SimulationError as SimulationError
from toolground.errors import MissingExtra as MissingExtra
from .harness.manoeuvres.parts import ManoeuvreError as ManoeuvreError
from driverecords.source import RecordingError as RecordingError
from .harness.design.kalman import DesignError as DesignError
from fmublocks.errors import BuildError as BuildError
from .fmus.errors import ParameterFileError as ParameterFileError
