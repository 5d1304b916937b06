"""Other controllers under the same supervision, to compare ours with; each is a file of its own."""
