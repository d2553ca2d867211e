"""What the filters of a bank read: the outputs of the model, with a sensor of its own in place of a voted signal."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from fddbench.detection.lpv_filter.gains import ChannelEntry
from fddbench.interfaces import AffineModel, Channel, Floats

__all__ = ["FlownOutputs"]


@dataclass(frozen=True, kw_only=True)
class FlownOutputs:
    """Channels of a bank, and where each of its filters finds the outputs of the model among them.

    Attributes
    ----------
    channels : tuple of Channel
    places : mapping of str to tuple of int
        By fault, for each output of the model a number of the channels.
    """

    channels: tuple[Channel, ...]
    places: Mapping[str, tuple[int, ...]]

    @classmethod
    def of(cls, model: AffineModel, sensors: Mapping[str, tuple[int | None, ChannelEntry | None]]) -> "FlownOutputs":
        """Channels for faults, by name with the output of a sensor's fault and what stands in its place.

        An output that every filter reads from a sensor of its own is left out.
        """
        own = {
            name: (place, entry) for name, (place, entry) in sensors.items() if place is not None and entry is not None
        }
        replaced = {place for place, _ in own.values() if all(own.get(name, (None,))[0] == place for name in sensors)}
        kept = [place for place in range(len(model.outputs)) if place not in replaced]
        channels = [model.outputs[place] for place in kept]
        usual = {place: number for number, place in enumerate(kept)}
        places = {}
        for name in sensors:
            mine = dict(usual)
            if name in own:
                place, entry = own[name]
                mine[place] = len(channels)
                channels.append(replace(model.outputs[place], signal=entry.signal or "", row=entry.row))
            places[name] = tuple(mine[place] for place in range(len(model.outputs)))
        return cls(channels=tuple(channels), places=places)

    def placed(self, M: Floats, name: str) -> Floats:
        """Matrices with a column for each output of the model as such with one for each channel, (..., rows, n_channels)."""
        found: Floats = np.zeros((*M.shape[:-1], len(self.channels)))
        found[..., list(self.places[name])] = M
        return found

    def bend(self, model: AffineModel) -> Floats:
        """``C A C^+``, by which outputs bend between two samples; none where some read sensors of their own: straight lines."""
        if len(self.channels) == len(model.outputs) and self.channels == model.outputs:
            bent: Floats = model.C @ model.A @ np.linalg.pinv(model.C)
            return bent
        return np.zeros((1, len(self.channels), len(self.channels)))
