"""Every manoeuvre on every plant, without and with damping."""
