"""The shot ranking discriminator: model, losses, training and inference. Knows nothing of the language."""
