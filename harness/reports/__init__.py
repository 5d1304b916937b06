"""Results for people and tools: tables, CSV files, figures."""
