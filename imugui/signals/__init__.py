"""Signals over time without a screen: channels, their history, what is drawn, spectrum and statistics."""
