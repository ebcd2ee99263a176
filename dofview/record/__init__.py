"""Films: settings for every frame of a path, and files that play even when the recording is cut off."""
