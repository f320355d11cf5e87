"""What the launcher of the flex template runs: a build of a city in a bucket.

    gcloud dataflow flex-template build gs://BUCKET/nostalgin.json \
        --image REGISTRY/nostalgin-dataflow:0.1.0 --sdk-language PYTHON \
        --metadata-file deploy/dataflow/metadata.json
    gcloud dataflow flex-template run nostalgin --region REGION \
        --template-file-gcs-location gs://BUCKET/nostalgin.json \
        --parameters city=gs://BUCKET/city \
        --parameters sdk_container_image=REGISTRY/nostalgin-dataflow:0.1.0

The image is the target `dataflow` of deploy/image/Dockerfile; workers use it, too.
The launcher has a time limit of its own: if it ends before the job does, artifacts and
tables are there, and `nostalgin build gs://BUCKET/city` finds and publishes them, as it
does after shards. Written to Google's documentation; not run by us.
"""

import argparse
import sys
from collections.abc import Sequence

from apache_beam.options.pipeline_options import PipelineOptions

from pipelines import build

RUNNER = "--runner=DataflowRunner"


def asked(words: Sequence[str]) -> PipelineOptions:
    """Read what the template was given; what is no word of ours goes to Beam."""
    parser = argparse.ArgumentParser(allow_abbrev=False)
    parser.add_argument("--city", required=True)
    parser.add_argument("--shard", default="")
    parser.add_argument("--schemes", default="gs")
    ours, rest = parser.parse_known_args(list(words))
    runner = [] if any(one.startswith("--runner") for one in rest) else [RUNNER]
    schemes = [one for one in ours.schemes.split(",") if one]
    return build.options(
        ours.city, shard=ours.shard, schemes=schemes, beam=[*runner, *rest]
    )


if __name__ == "__main__":
    build.build(asked(sys.argv[1:]))
