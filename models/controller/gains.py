"""Designed parameters of the controller; written by `driveline design`."""

lambda_v = 0.913
K_omega_1 = 0.306762
K_omega_2 = 0.185902
K_phi = -0.0075846
K_T_l = 0.0545071
Kw_omega_1 = 0.306634
Kw_omega_2 = 0.185395
Kw_phi = -0.00757399
Kw_T_l = 0.0543771
H_omega_1 = 0.000902347
H_omega_2 = 0.00402539
H_phi = -7.93456e-05
H_T_l = 0.00110986
T_age = 0.023
T_pred = 0.00424264
k_d = 2.47722
k_T = 0.0255
k_gap = 0.665
omega_w = 4.25
T_land = 60
t_land = 0.1
