"""Instances of single FMUs, of those that a module calls `native`."""

from fmutesting.host import instance

motor = instance("native", "MotorTorqueLoop")
can = instance("native", "WheelSpeedCan")
plant = instance("native", "TwoMassDriveline")
controller = instance("native", "DampingController")
