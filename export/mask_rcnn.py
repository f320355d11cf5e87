"""A small Mask R-CNN finds fronts and what hides them in one gray photograph.

He et al., "Mask R-CNN", ICCV 2017, on MobileNetV2 (Sandler et al., CVPR 2018) with a
feature pyramid of 128 channels: 7.2 million parameters, with the semantic branch
(`semantic_branch`) that tells every pixel what it is and a head (`indoors`) that tells
rooms from streets. The backbone carries no batch
norm (it was folded into the convolutions), so that training with one photo a pass
needs nothing special.

Input: gray values 0 to 255, shape (n, 1, h, w), h and w multiples of 32. A detection
is a box in input pixels, a label (its place in `CATEGORIES`, from 1), a score and a
mask of probabilities over its box.
"""

from collections.abc import Mapping

import numpy as np
import torch
from torch import Tensor, nn
from torch.nn import functional
from torchvision.models.detection.anchor_utils import AnchorGenerator
from torchvision.models.detection.faster_rcnn import FastRCNNPredictor, TwoMLPHead
from torchvision.models.detection.image_list import ImageList
from torchvision.models.detection.mask_rcnn import MaskRCNNHeads, MaskRCNNPredictor
from torchvision.models.detection.roi_heads import RoIHeads
from torchvision.models.detection.rpn import RegionProposalNetwork, RPNHead
from torchvision.ops import FeaturePyramidNetwork, MultiScaleRoIAlign
from torchvision.ops.feature_pyramid_network import LastLevelMaxPool

from export.indoors import Indoors
from export.semantic_branch import SemanticBranch, losses, probabilities
from nostalgin_core.segment import CATEGORIES

# Expansion, channels, repeats, stride: table 2 of the MobileNetV2 paper.
STAGES = (
    (1, 16, 1, 1),
    (6, 24, 2, 2),
    (6, 32, 3, 2),
    (6, 64, 4, 2),
    (6, 96, 3, 1),
    (6, 160, 3, 2),
    (6, 320, 1, 1),
)
TAPS = (2, 5, 12, 16)  # the last blocks at strides 4, 8, 16 and 32
CHANNELS = 128  # of the pyramid; 256 doubles the time
MASK_CELLS = 23  # a side; masks come out at twice that: the paper's 46 for facades
FROZEN_BLOCKS = 6  # strides 2 to 8: edges are edges in any decade
PROPOSING = ("1", "2", "3", "pool")  # stride 4 would double the work and find nothing


class SameConv(nn.Conv2d):
    """A convolution padded as TensorFlow pads inputs of even size."""

    def forward(self, x: Tensor) -> Tensor:
        """Keep the size at stride 1; halve it at stride 2, padding right and below."""
        if self.kernel_size[0] == 3:
            x = functional.pad(x, (0, 1, 0, 1) if self.stride[0] == 2 else (1, 1, 1, 1))
        return functional.conv2d(
            x, self.weight, self.bias, self.stride, 0, 1, self.groups
        )


class Bottleneck(nn.Module):
    """Widens, filters each channel by itself, and narrows again."""

    def __init__(
        self, narrow_in: int, narrow_out: int, stride: int, widening: int
    ) -> None:
        """Skip the widening where it is 1."""
        super().__init__()
        wide = narrow_in * widening
        self.expand = SameConv(narrow_in, wide, 1) if widening != 1 else None
        self.depthwise = SameConv(wide, wide, 3, stride, groups=wide)
        self.project = SameConv(wide, narrow_out, 1)
        self.residual = stride == 1 and narrow_in == narrow_out

    def forward(self, x: Tensor) -> Tensor:
        """Map (n, narrow_in, h, w) to (n, narrow_out, h / stride, w / stride)."""
        y = x if self.expand is None else functional.relu6(self.expand(x))
        y = self.project(functional.relu6(self.depthwise(y)))
        return x + y if self.residual else y


class MobileNetV2(nn.Module):
    """The backbone's seven stages, tapped at four strides."""

    def __init__(self) -> None:
        """Stack the stages of the table above."""
        super().__init__()
        self.stem = SameConv(1, 32, 3, 2)
        blocks, narrow = [], 32
        for widening, channels, repeats, stride in STAGES:
            for i in range(repeats):
                step = stride if i == 0 else 1
                blocks.append(Bottleneck(narrow, channels, step, widening))
                narrow = channels
        self.blocks = nn.ModuleList(blocks)

    def forward(self, x: Tensor) -> dict[str, Tensor]:
        """Return features at strides 4, 8, 16 and 32, named "0" to "3"."""
        x = functional.relu6(self.stem(x))
        taps = {}
        for i, block in enumerate(self.blocks):
            x = block(x)
            if i in TAPS:
                taps[str(len(taps))] = x
        return taps


class Backbone(nn.Module):
    """MobileNetV2 and a feature pyramid with one more level at stride 64."""

    def __init__(self) -> None:
        """Give every tap the same number of channels."""
        super().__init__()
        self.body = MobileNetV2()
        widths = [24, 32, 96, 320]
        self.fpn = FeaturePyramidNetwork(widths, CHANNELS, LastLevelMaxPool())

    def forward(self, x: Tensor) -> dict[str, Tensor]:
        """Return five levels of `CHANNELS` channels each."""
        return self.fpn(self.body(x))

    def both(self, x: Tensor) -> tuple[dict[str, Tensor], dict[str, Tensor]]:
        """Return the body's four taps, and the five levels made of them."""
        taps = self.body(x)
        return taps, self.fpn(dict(taps))


class MaskRCNN(nn.Module):
    """Backbone, region proposals, box head, mask head and semantic branch."""

    def __init__(self, *, detections: int = 40, score: float = 0.2) -> None:
        """Keep at most `detections` things, each surer than `score`.

        40 is twice what a photograph of the training set shows; every mask costs time.
        """
        super().__init__()
        self.backbone = Backbone()
        self.rpn = _proposals()
        self.roi_heads = _heads(detections, score)
        self.branch = SemanticBranch(CHANNELS)
        self.indoors = Indoors()

    def forward(
        self, gray: Tensor, targets: list[dict[str, Tensor]] | None = None
    ) -> tuple[Tensor, ...] | dict[str, Tensor]:
        """Return boxes, labels, scores, masks, pixels, indoors; losses if training."""
        height, width = gray.shape[-2:]
        images = ImageList(gray, [(height, width)] * gray.shape[0])
        taps, features = self.backbone.both(gray / 127.5 - 1)
        if self.training:  # the finest level costs a third of the backward pass
            features["0"] = features["0"].detach()
        coarse = {level: features[level] for level in PROPOSING}
        proposals, rpn_losses = self.rpn(images, coarse, targets)
        found, lost = self.roi_heads(features, proposals, images.image_sizes, targets)
        levels = list(features.values())
        if targets is not None and self.training:
            if not self.branch.learning:
                return rpn_losses | lost
            logits = self.branch(taps, levels)
            return rpn_losses | lost | losses(logits, targets[0]["cells"])
        logits = self.branch(taps, levels)
        first, pixels = found[0], probabilities(logits)[0]
        things = (*(first[part] for part in ("boxes", "labels", "scores")),)
        return *things, first["masks"][:, 0], pixels, self.indoors(taps)[0]

    def branch_losses(
        self, gray: Tensor, targets: list[dict[str, Tensor]]
    ) -> dict[str, Tensor]:
        """Return the semantic branch's losses alone, all before it held as it is."""
        return losses(self.pixel_logits(gray), targets[0]["cells"])

    def pixel_logits(self, gray: Tensor) -> Tensor:
        """Return the semantic branch's answer alone: a fifth of the whole's work."""
        with torch.no_grad():
            taps, features = self.backbone.both(gray / 127.5 - 1)
        return self.branch(taps, list(features.values()))


def _proposals() -> RegionProposalNetwork:
    sizes = ((48,), (96,), (192,), (384,))
    # Fronts are up to three times as tall as wide, rows of cars as wide as tall.
    anchors = AnchorGenerator(sizes, ((0.33, 0.7, 1.4, 3.0),) * 4)
    return RegionProposalNetwork(
        anchors,
        RPNHead(CHANNELS, 4),
        fg_iou_thresh=0.7,
        bg_iou_thresh=0.3,
        batch_size_per_image=256,
        positive_fraction=0.5,
        pre_nms_top_n={"training": 600, "testing": 300},
        post_nms_top_n={"training": 400, "testing": 150},
        nms_thresh=0.7,
    )


def _heads(detections: int, score: float) -> RoIHeads:
    levels = ["0", "1", "2", "3"]
    classes = len(CATEGORIES) + 1
    return RoIHeads(
        MultiScaleRoIAlign(levels, 7, 2),
        TwoMLPHead(CHANNELS * 49, 512),
        FastRCNNPredictor(512, classes),
        fg_iou_thresh=0.5,
        bg_iou_thresh=0.5,
        batch_size_per_image=64,  # more photos teach more than more boxes of one
        positive_fraction=0.25,
        bbox_reg_weights=None,
        score_thresh=score,
        nms_thresh=0.5,
        detections_per_img=detections,
        mask_roi_pool=MultiScaleRoIAlign(levels, MASK_CELLS, 2),
        mask_head=MaskRCNNHeads(CHANNELS, (CHANNELS,) * 4, 1),
        mask_predictor=MaskRCNNPredictor(CHANNELS, CHANNELS, classes),
    )


def load_weights(network: MaskRCNN, weights: Mapping[str, np.ndarray]) -> MaskRCNN:
    """Put named arrays into the network, whatever precision they were kept in.

    A stem that saw colour is summed over its three inputs: gray, three times, is what
    it was shown. Raises RuntimeError where a name is missing or has another shape.
    """
    state = {k: torch.from_numpy(v.astype(np.float32)) for k, v in weights.items()}
    stem = "backbone.body.stem.weight"
    if stem in state:
        state[stem] = state[stem].sum(1, keepdim=True)
    network.load_state_dict(state)
    return network.to(memory_format=torch.channels_last)  # halves the time on a CPU


def freeze(
    network: MaskRCNN, *, but_branch: bool = False, but_boxes: bool = False
) -> None:
    """Leave the first, widest stages as they are, or all but the branch or boxes.

    Where proposals and boxes alone learn, masks and pixels are not asked for in
    training: they are most of its work. Raises ValueError where both learn alone.
    """
    if but_branch and but_boxes:
        raise ValueError("but_branch and but_boxes leave nothing to learn together")
    body, heads = network.backbone.body, network.roi_heads
    parts: tuple[nn.Module, ...] = (body.stem, *body.blocks[:FROZEN_BLOCKS])
    if but_branch:
        parts = (network.backbone, network.rpn, heads)
    if but_boxes:
        masks = (heads.get_submodule(f"mask_{part}") for part in ("head", "predictor"))
        parts = (network.backbone, network.branch, *masks)
        heads.mask_roi_pool = None  # so that RoIHeads draws none
    for part in parts:
        part.requires_grad_(requires_grad=False)
