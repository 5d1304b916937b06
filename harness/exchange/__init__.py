"""The loop in the formats and on the targets of others, a room each."""
