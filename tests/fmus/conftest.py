"""Instances of single FMUs, of those that a module calls `built`."""

from fmutesting.host import instance

motor = instance("built", "MotorTorqueLoop")
can = instance("built", "WheelSpeedCan")
plant = instance("built", "TwoMassDriveline")
controller = instance("built", "DampingController")
