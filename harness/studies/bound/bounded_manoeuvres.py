"""Which manoeuvres are bounded: steps, and a steep ramp, in which the teeth leave their flank at most once."""

BOUNDED_MANOEUVRES = ("tipin15", "tipin50", "tipin0", "tipout", "launch")
