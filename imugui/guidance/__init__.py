"""Guidance: plans, registration, aiming error, trust, and the readings that are kept."""
