"""What all tests share: one hypothesis profile, and signals that are not ignored.

There is no deadline for examples, as the first run of a shape includes its compilation.
"""

import signal

from hypothesis import HealthCheck, settings

settings.register_profile(
    "scans",
    deadline=None,
    derandomize=False,
    max_examples=20,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)
settings.load_profile("scans")

# shells ignore Ctrl-C in what they put into the background, nohup ignores SIGHUP, and processes inherit that
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
if hasattr(signal, "SIGHUP") and signal.getsignal(signal.SIGHUP) is signal.SIG_IGN:
    signal.signal(signal.SIGHUP, signal.SIG_DFL)
