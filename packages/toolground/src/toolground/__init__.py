"""What every other room may use: errors, text, files, progress, interruption; knows no FMU."""
