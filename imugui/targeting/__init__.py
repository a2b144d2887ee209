"""The targeting game, pure: the controller that steers a field of view, its measures and their statistics."""
