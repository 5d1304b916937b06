"""Design of the damping controller. Written by `driveline design`; do not edit."""

lambda_v = 0.913
K_omega_1 = 0.4
K_omega_2 = 0.02
K_phi = 0.0008
K_T_l = 0.01
Kw_omega_1 = 0.4
Kw_omega_2 = 0.02
Kw_phi = 0.0008
Kw_T_l = 0.01
H_omega_1 = 0.0
H_omega_2 = 0.1
H_phi = 0.0
H_T_l = 0.0
T_age = 0.023
T_pred = 0.0042
k_d = 2.43
k_gap = 0.665
k_T = 0.036
omega_w = 4.25
T_land = 60.0
t_land = 0.1
