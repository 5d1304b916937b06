"""Rosenbrock method of order 4 with 6 stages, L-stable and stiffly accurate.

Coefficients of RODAS: E. Hairer, G. Wanner, "Solving Ordinary Differential Equations II", 2nd ed.,
Springer 1996, section IV.7. Written for the unknowns u_i of

    (1/(h GAMMA) - J) u_i = f(t + C[i] h, x + sum A[i][j] u_j) + sum G[i][j] u_j/h + D[i] h df/dt

the end is x plus the sum of A[5] and u_5, and u_5 is the error of the embedded order 3.
"""

GAMMA = 0.25

A: tuple[tuple[float, ...], ...] = (
    (),
    (1.544,),
    (0.9466785280815826, 0.2557011698983284),
    (3.314825187068521, 2.896124015972201, 0.9986419139977817),
    (1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950),
    (1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950, 1.0),
)
"""Weights of the earlier unknowns in the state of each stage."""

G: tuple[tuple[float, ...], ...] = (
    (),
    (-5.6688,),
    (-2.430093356833875, -0.2063599157091915),
    (-0.1073529058151375, -9.594562251023355, -20.47028614809616),
    (7.496443313967647, -10.24680431464352, -33.99990352819905, 11.70890893206160),
    (8.083246795921522, -7.981132988064893, -31.52159432874371, 16.31930543123136, -6.058818238834054),
)
"""Weights of the earlier unknowns over h in each stage."""

C: tuple[float, ...] = (0.0, 0.386, 0.21, 0.63, 1.0, 1.0)
"""Time of each stage."""

D: tuple[float, ...] = (0.25, -0.1043, 0.1035, -0.0362, 0.0, 0.0)
"""Weights of the rate of change of f with time, which moves with inputs only."""
