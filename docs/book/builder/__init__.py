"""What `docs/book/build.py` builds the book with."""
