"""The paper's tables and public benchmarks, on data that is given.

The measures are pure and live in the core; here are the readers of data sets and the
loops over them.
"""


class Unmeasurable(ValueError):  # noqa: N818 - it reads as what it is about
    """Data that nothing can be measured on, with what to do about it."""
