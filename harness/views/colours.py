"""The colours of Okabe and Ito, and two of Paul Tol, olive and wine: the colour-blind can tell them apart."""

BLACK, BLUE, VERMILION, GREEN, GREY = "black", "#0072B2", "#D55E00", "#009E73", "#999999"
ORANGE, PURPLE, SKY, OLIVE, WINE = "#E69F00", "#CC79A7", "#56B4E9", "#999933", "#882255"

COLOURS = (BLACK, GREY, BLUE, ORANGE, VERMILION, GREEN, PURPLE, SKY)
"""Of many curves, in turn."""
