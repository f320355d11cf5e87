"""A page on which people see what was read and found, and write corrections.

In: a city folder, built or not. Out: one HTML file that needs no network and no server.
Open `review` first.
"""

from pipelines.review.page import page
from pipelines.review.review import Unkept, review

__all__ = ["Unkept", "page", "review"]
