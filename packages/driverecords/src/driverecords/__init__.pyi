from .channels import Channel as Channel
from .drive import Drive as Drive
from .drive import read_drive as read_drive
from .findings import Finding as Finding
from .measurement import Measurement as Measurement
from .measurement import read_measurement as read_measurement
from .plausibility import of_drive as of_drive
from .source import RecordingError as RecordingError
