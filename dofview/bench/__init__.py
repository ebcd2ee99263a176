"""Run time against error: sweeps of scenes, methods, lenses and sizes, judged by the matched reference."""
