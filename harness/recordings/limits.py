"""What the file of a recording may take. A drive of an hour at 1 kHz and one of a million rows and twenty columns have
a tenth to a half of it; what takes more is an accident or an attack."""

LARGEST_TEXT = 500_000_000
"""Bytes of a text file; what is read in the time below. MDF and Parquet hold ten times as many samples."""

LONGEST_LINE = 1_000_000
"""Characters of a line of text. Loggers write some thousands."""

MOST_COLUMNS = 10_000
"""Of a text file. The names of all of them are looked at."""

LARGEST_NOTE = 1_000_000
"""Bytes of the record beside results of ours, which tells their units."""

SMALL_TEXT = 20_000_000
"""Bytes of a text file that needs no process of its own: none takes more than some seconds, since texts are read piece
by piece and unpack to nothing."""

SECONDS = 30
"""Of computing in which all other files must have been read; a log of a bus with four million frames takes 20."""

PATIENCE = 10 * SECONDS
"""Seconds in which they must have been read on a machine that is busy, or by a disk that is slow."""

MEMORY = 1_500_000_000
"""Bytes that the process has that reads them; who waits for it takes what it answers, which is part of that."""
