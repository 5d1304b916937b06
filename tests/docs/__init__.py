"""The documentation, as it is in the checkout and as a site."""
