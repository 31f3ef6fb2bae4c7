"""The shot ranking discriminator: model, losses, training and inference. Knows nothing of the language."""

from .errors import RankerError

__all__ = ["RankerError"]
