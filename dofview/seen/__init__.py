"""What a screen shows of a scene, as one image: a picture, a wipe, a grid of all, error maps, overlays.

The window shows this image, and films and screenshots are read from it, with a window and without one.
"""
