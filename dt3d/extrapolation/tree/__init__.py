"""Beyond the paper: a tree of boxes in place of uniform cells, for sites that do not fill space evenly."""
