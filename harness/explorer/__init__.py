"""The page of `driveline explore`: the loop as WebAssembly, what can be turned, and what follows from a car."""
