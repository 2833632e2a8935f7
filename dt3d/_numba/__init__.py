"""Tools for functions compiled by numba; importing the package, `cores` or `kernel_cache` loads no numba."""
