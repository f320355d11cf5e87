"""Counts as people write them: 1 photo, 2 photos."""


def of(count: int, one: str, many: str = "") -> str:
    """Write a count and what is counted; of what takes no s, name the `many`."""
    return f"{count:,} {one if count == 1 else many or f'{one}s'}"
