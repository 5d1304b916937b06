"""Which signal of a run is what a metric, a figure or a judge asks for.

A role is called as its signal is in a loop of one drive unit. In a loop of several, each unit has its own signals for
the roles, see `harness.loop.topology`; a run is read as one of its units sees it.
"""

DEMAND = "controller.T_driver"
ENABLE = "controller.enable"
REFERENCE_TORQUE = "controller.T_ref"
DAMPING_TORQUE = "controller.T_damp"
STATUS = "controller.status"
CAUSE = "controller.cause"
GEAR_TORQUE_ESTIMATE = "controller.T_gear_hat"
TWIST_ESTIMATE = "controller.phi_hat"

MOTOR_TORQUE = "motor.T_mot"
MOTOR_TORQUE_ESTIMATE = "motor.T_mot_est"
MEASURED_MOTOR_SPEED = "motor.omega_1_meas"
LARGEST_TORQUE = "motor.T_max"

BUS_WHEEL_SPEED = "can.omega_2_can"
BUS_VALID = "can.valid"
BUS_COUNTER = "can.counter"

GEAR_TORQUE = "plant.T_gear"
MOTOR_SPEED = "plant.omega_1"
WHEEL_SPEED = "plant.omega_2"
WHEELS = ("plant.omega_wheel_L", "plant.omega_wheel_R")
RIM_TORQUE = "plant.T_rim"
BODY_SPEED = "plant.v"
BODY_ACCELERATION = "plant.a_body"
BRAKE_TORQUE = "plant.T_brake"
SLOPE = "plant.slope"
FIRST_SPEED = "plant.v_0"
FIRST_TORQUE = "plant.T_0"
