import json
import struct

import pytest

from nostalgin_core.model.model import model
from tests.core import sample_block as sample


def test_the_model_tells_each_building_s_measures_and_the_credit() -> None:
    settled, views = sample.settled("1"), sample.elevations("1")
    data, whole = model(settled, views, credit="An Archive")
    (length,) = struct.unpack_from("<I", data, 12)
    document = json.loads(data[20 : 20 + length])
    metadata = document["extensions"]["EXT_structural_metadata"]
    properties = metadata["schema"]["classes"]["building"]["properties"]
    assert {"id", "block", "lot", "address", "assumed", "photo", "credit"} <= set(
        properties
    )
    assert properties["height_m"] == {"type": "SCALAR", "componentType": "FLOAT32"}
    assert document["asset"]["copyright"] == "An Archive"
    assert document["asset"]["extras"]["block"] == "1"
    highest = max(one.height_m for one in settled.block.buildings)
    assert whole.positions_m[:, 2].max() == pytest.approx(highest)
