"""What the driver, the brakes and the road do: manoeuvres and recorded drives."""
