"""What is asked of the loop, a room each."""
