"""The Monte-Carlo: cars and sensors by lot, the same ones for every controller."""
