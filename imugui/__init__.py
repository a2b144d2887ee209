"""imugui: a cheap IMU board as an instrument one can trust."""

__version__ = "0.1.0"
