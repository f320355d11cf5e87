from pathlib import Path

import onnx
import pytest
import torch

from export.attention import Attention, decide, paste, patches
from export.inpainter import Critic, Generator
from export.inpainter_onnx import TOLERANCE, export, parity
from export.train_inpainter import begin


@pytest.fixture(scope="module")
def generator() -> Generator:
    torch.manual_seed(0)
    small = Generator(width=8)
    with torch.no_grad():
        for weights in small.parameters():
            weights.add_(0.03 * torch.randn_like(weights))
    return small.eval()


def question(h: int, w: int) -> tuple[torch.Tensor, ...]:
    torch.manual_seed(1)
    image, guess = torch.rand(2, 1, 1, h, w) * 2 - 1
    hole = torch.zeros(1, 1, h, w)
    hole[..., h // 4 : h // 2, w // 4 : w // 2] = 1
    return image, hole, guess


def test_known_pixels_pass_unchanged_and_hidden_ones_are_not_looked_at(
    generator: Generator,
) -> None:
    image, hole, guess = question(48, 64)
    with torch.no_grad():
        coarse, fine = generator(image, hole, guess)
        other = generator(image + hole * torch.rand_like(image), hole, guess)[1]
    for made in (coarse, fine):
        assert torch.equal(made * (1 - hole), image * (1 - hole))
    assert torch.equal(fine, other)


def test_a_fresh_network_answers_almost_with_its_guess() -> None:
    torch.manual_seed(0)
    image, hole, guess = question(32, 32)
    with torch.no_grad():
        made = Generator(width=8)(image, hole, guess)[1]
    assert ((made - guess) * hole).abs().max() < 0.2


@pytest.mark.parametrize("strips", [2, 3, 8])
def test_attention_in_strips_is_attention(generator: Generator, strips: int) -> None:
    asked = question(72, 40)
    with torch.no_grad():
        whole, cut = generator(*asked)[1], generator(*asked, strips=strips)[1]
    assert torch.allclose(whole, cut, atol=1e-5)


def test_pasting_cut_patches_gives_the_features_again() -> None:
    x = torch.rand(1, 3, 12, 16)
    again = paste(patches(x, size=4, stride=2))
    assert torch.allclose(again[:, :, 1:-1, 1:-1], x[:, :, 1:-1, 1:-1])


@pytest.mark.parametrize(("stride", "period"), [(1, 8), (2, 2)])
def test_attention_copies_a_texture_into_the_hole(stride: int, period: int) -> None:
    columns = (torch.arange(32) % period < period // 2).float()
    x = torch.stack([columns, 1 - columns])[None, :, None].expand(1, 2, 32, 32)
    hole = torch.zeros(1, 1, 32, 32)
    hole[..., 12:18, 12:18] = 1
    made = Attention(stride=stride, sharpness=50.0)(x, hole)
    assert (made - x)[..., 8:24, 8:24].abs().max() < 0.1


def test_attention_without_anything_known_answers_zero() -> None:
    x = torch.rand(1, 2, 16, 16)
    assert torch.equal(Attention()(x, torch.ones(1, 1, 16, 16)), torch.zeros_like(x))


def test_weights_add_up_to_one_and_none_is_too_small_to_reckon_with() -> None:
    scores = -torch.arange(0, 120, 0.25).reshape(1, 1, -1)
    offered = torch.ones_like(scores)
    offered[..., :4] = 0
    weights = decide(scores, offered)
    assert torch.isclose(weights.sum(), torch.tensor(1.0))
    assert (weights[..., :4] == 0).all()
    used = weights[weights > 0]
    assert used.min() > 1e3 * torch.finfo(torch.float32).tiny
    assert len(used) < scores.numel() - 4  # the softmax alone would use them all


def test_even_kernels_are_refused() -> None:
    with pytest.raises(ValueError, match="odd"):
        Generator(width=8, kernels=(20, 10, 5))


def test_the_critic_judges_every_patch() -> None:
    image, hole, _ = question(128, 192)
    assert Critic(width=4)(image, hole).shape == (1, 16, 2, 3)


def test_training_goes_on_from_a_shipped_file(
    generator: Generator, tmp_path: Path
) -> None:
    file = tmp_path / "inpaint.onnx"
    file.write_bytes(export(generator, facts={"steps": "4800"}))
    trainer = begin(tmp_path / "none.pt", {"width": 8}, device="cpu", start=file)
    assert trainer.step == 4800
    for given in (trainer.generator.eval(), trainer.smoothed()):
        with torch.no_grad():
            one, other = given(*question(48, 64))[1], generator(*question(48, 64))[1]
        assert (one - other).abs().max() < TOLERANCE  # of weights in half precision
    untaught = begin(tmp_path / "none.pt", {"width": 8}, device="cpu")
    assert untaught.step == 0


def test_torch_and_onnx_agree_at_sizes_never_exported(generator: Generator) -> None:
    data = export(generator, strips=3, facts={"steps": "0"})
    assert parity(generator, data, [(64, 96), (40, 24), (120, 56)]) < 5e-3
    props = onnx.load_from_string(data).metadata_props
    facts = {one.key: one.value for one in props}
    assert facts == {"multiple": "8", "steps": "0"}
