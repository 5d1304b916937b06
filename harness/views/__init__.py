"""Results for people and tools: tables, figures, files of signals, pages."""
