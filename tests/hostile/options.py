"""Options and words of the command line that make no sense."""

from pathlib import Path
from typing import Final

from tests.hostile.case import Case, Make
from tests.hostile.folders import filled
from tests.hostile.networks import write_sound
from tests.pipelines import painted

SURROGATE: Final = "\udcff"  # as a byte that is no UTF-8 comes in
USAGE: Final = 2


def alone(*words: str) -> Make:
    return lambda _: words


def built(*words: str) -> Make:
    """Build a sound city with hostile options; nothing of it may be begun."""

    def make(folder: Path) -> list[object]:
        filled("5_1.png", painted.photo(), folder / "photos")
        (folder / "city").mkdir()
        row = "../photos,5_1.png,5-1-0,5,1\n"
        text = f"root,photo,front_id,block,lot\n{row}"
        (folder / "city" / "manifest.csv").write_text(text)
        models = write_sound(folder / "models")
        return ["build", "city", "--models", models.name, *words]

    return make


def indexed(*words: str) -> Make:
    def make(folder: Path) -> list[object]:
        filled("5_1.png", painted.photo(), folder / "photos")
        return ["index", "photos", "-o", "city", *words]

    return make


def cases() -> list[Case]:
    """List all hostile options."""
    return [*shards(), *runners(), *ranges(), *surrogates(), *others()]


def shards() -> list[Case]:
    texts = ["4/3", "-1/2", "0/1", "1/0", "1", "x", "1/2/3", "1.5/2", "/", "\u00b2/3"]
    texts += ["9" * 5000 + "/1", " 1/2", "1/\u221e"]
    return [
        Case(f"shard {text[:9]}", built(f"--shard={text}"), USAGE, ("--shard",))
        for text in texts
    ]


def runners() -> list[Case]:
    given = {
        "unknown": ["--runner", "Nowhere"],
        "of a missing module": ["--runner", "nowhere.Runner"],
        "a function": ["--runner", "json.loads"],
        "a path": ["--runner", "../../x"],
        "without its extra": ["--runner", "DataflowRunner"],
    }
    workers = ["-1", "x", "1.5", "1e9", "nan"]
    dead = ["--runner", "PortableRunner", "--job_endpoint", "127.0.0.1:1"]
    return [
        *(
            Case(f"runner {name}", built(*words), USAGE, ("runner",))
            for name, words in given.items()
        ),
        *(
            Case(
                f"workers {one}",
                built(f"--direct_num_workers={one}"),
                USAGE,
                ("workers",),
            )
            for one in workers
        ),
        Case("runner at a dead end", built(*dead), 1, ("127.0.0.1:1",), writes="city"),
        Case("mode of nothing", built("--direct_running_mode=x"), USAGE, ("mode",)),
        Case("city twice", built("--city=elsewhere"), USAGE, ("--city",)),
        Case("option of nobody", built("--no-such-option=1"), USAGE, ("--no-such",)),
        Case("word of nobody", built("another-city"), USAGE, ("another-city",)),
    ]


def ranges() -> list[Case]:
    given = [("--max-rejected", one) for one in ("-0.1", "1.1", "inf", "nan", "half")]
    return [
        *(
            Case(f"{name} {one}", built(name, one), USAGE, (name,))
            for name, one in given
        ),
        *(
            Case(
                f"port {one}", alone("view", "city", "--port", one), USAGE, ("--port",)
            )
            for one in ("-1", "65536", "http", "", "1e3")
        ),
        *(
            Case(f"blocks {one}", alone("demo", "--blocks", one), USAGE, ("--blocks",))
            for one in ("0", "4", "-1", "x")
        ),
    ]


def surrogates() -> list[Case]:
    """Give bytes that are no UTF-8 in every place where words may stand."""
    one, spelt, shown = SURROGATE, "\\xff", "\\udcff"
    kept = {"writes": "city", "keeps": ("5_1.png",)}
    return [
        Case(
            "bytes for a folder",
            alone("index", one, "-o", "city"),
            1,
            ("is no folder",),
        ),
        Case("bytes for a city", alone("build", one), 1, (spelt,)),
        Case("bytes for a site", alone("view", one), 1, (shown,)),
        Case("bytes for a photo", alone("explain", one, "-o", "out"), 1, (shown,)),
        Case("bytes for a list", indexed("--catalogue", one), 1, (shown,)),
        Case("bytes for a block", indexed("--block", one), 1, (shown,)),
        Case("bytes for a credit", indexed("--credit", one), 1, (spelt,)),
        Case("bytes for a title", indexed("--title", one), 0, **kept),
        Case("bytes for networks", built("--models", one), USAGE, (spelt,)),
        Case("bytes for a shard", built("--shard", one), USAGE, ("--shard",)),
        Case("bytes for a runner", built("--runner", one), USAGE, ("ff:",)),
        Case("bytes for an output", output, 1, (spelt,)),
    ]


def output(folder: Path) -> list[object]:
    filled("5_1.png", painted.photo(), folder / "photos")
    return ["index", "photos", "-o", SURROGATE]


def others() -> list[Case]:
    long = "x" * 5000
    kept = {"writes": "city", "keeps": ("5_1.png",)}
    return [
        Case("no command", alone("no-such-command"), USAGE, ("no-such-command",)),
        Case("no photo", alone("explain"), USAGE, ("'photo'",)),
        Case("no output", alone("index", "photos"), USAGE, ("--out",)),
        Case("long name of a city", alone("build", long), 1),
        Case("long name of a site", alone("view", long), 1),
        Case("long name of a photo", alone("explain", long, "-o", "out"), 1),
        Case("long name of a list", indexed("--catalogue", long), 1),
        Case("block that is nowhere", indexed("--block", "../.."), 1, ("../..",)),
        Case("title of a page", indexed("--title", "<script>\n" * 999), 0, **kept),
        Case("credit of a page", indexed("--credit", "<script>\n" * 999), 0, **kept),
        Case("address of nobody", alone("build", "foo://city"), 1, ("foo://city",)),
        Case(
            "address of a page", alone("build", "http://127.0.0.1:9/x"), 1, ("http:",)
        ),
    ]
