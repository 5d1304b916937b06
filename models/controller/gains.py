"""Designed parameters of the controller; written by `driveline design`."""

lambda_v = 0.913
L_omega_1 = 0.306762
L_omega_2 = 0.185902
L_phi = -0.0075846
L_T_l = 0.0545071
Lw_omega_1 = 0.306634
Lw_omega_2 = 0.185395
Lw_phi = -0.00757399
Lw_T_l = 0.0543771
L_can_omega_1 = 0.000902347
L_can_omega_2 = 0.00402539
L_can_phi = -7.93456e-05
L_can_T_l = 0.00110986
T_age = 0.023
T_pred = 0.00424264
k_d = 2.47722
k_T = 0.0255
k_gap = 0.665
omega_w = 4.25
T_land = 60
t_land = 0.1
