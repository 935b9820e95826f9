"""Drawings of the book: an SVG page, geometry in space, and the figures."""
