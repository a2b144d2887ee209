"""Calibration: what is wrong with a board's sensors, found by guided flows, kept in a profile."""
