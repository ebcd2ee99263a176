"""Stress: random and cornered settings for every method, judged by invariants with stated bounds.

Each case is a row, a method and a seed, so whatever fails is repeated by one command line.
"""
