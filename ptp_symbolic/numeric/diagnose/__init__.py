"""From the residual of the declared model to ranked candidates and a verdict."""
