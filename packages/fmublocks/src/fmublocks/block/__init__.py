"""What a block is and how it runs: types, declarations, operators, integrator, runner."""
