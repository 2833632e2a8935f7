"""Beyond the paper: sites as they are, every decision exact, cospherical sites by a symbolic perturbation."""
