"""An elevation's marks in sum, so that one among many that looks like it is found.

The marks of a ring are sorted by words, the means of marks that are alike; an elevation
is by how much its own marks differ from each word (vectors of locally aggregated
descriptors; Jégou et al., 2010). Two such sums are compared in microseconds, which two
elevations never are: what is alike in sum is worth a closer look, no more.
"""

import warnings
from collections.abc import Sequence
from typing import Final

import numpy as np
import scipy
from jaxtyping import Float32

from nostalgin_core.views.marks import Marks

WORDS: Final = 64
MARKS: Final = 100  # of an elevation, from which words are learnt
ROUNDS: Final = 8

Words = Float32[np.ndarray, "words 128"]
Summary = Float32[np.ndarray, " words*128"]


def words(some: Sequence[Marks]) -> Words:
    """Learn words from the marks of elevations; fewer where there are few marks."""
    looks = [one.looks[:: max(1, len(one.looks) // MARKS)] for one in some]
    every = np.unique(np.concatenate(looks), axis=0)
    if len(every) <= WORDS:
        return every
    with warnings.catch_warnings():  # a word that no mark is like stays as it is
        warnings.simplefilter("ignore", UserWarning)
        rng = np.random.default_rng(0)
        found, _ = (
            scipy.cluster.vq.kmeans2(  # which SciPy loads when it is first asked for
                every, WORDS, iter=ROUNDS, minit="points", rng=rng
            )
        )
    return found.astype(np.float32)


def summary(one: Marks, by: Words) -> Summary:
    """Sum up marks by words, to a length of 1; 0 where there are none."""
    summed = np.zeros_like(by)
    if len(one.looks) and len(by):
        word, _ = scipy.cluster.vq.vq(one.looks, by)
        np.add.at(summed, word, one.looks - by[word])
    lengths = np.linalg.norm(summed, axis=1, keepdims=True)
    summed = np.divide(summed, lengths, out=summed, where=lengths > 0).ravel()
    return summed / max(float(np.linalg.norm(summed)), np.finfo(np.float32).tiny)
