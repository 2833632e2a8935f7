"""Beyond the paper: threads locate several sites at a time and load what their insertions will need."""
