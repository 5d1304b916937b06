"""The Monte-Carlo: random cars and sensors, the same ones for every controller."""
