"""One hypothesis profile for all tests: no deadline, as the first run of a shape includes its compilation."""

from hypothesis import HealthCheck, settings

settings.register_profile(
    "scans",
    deadline=None,
    derandomize=False,
    max_examples=20,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)
settings.load_profile("scans")
