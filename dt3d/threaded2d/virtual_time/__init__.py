"""Beyond the paper: the methods on simulated processing elements, whose clocks are counted forward."""
