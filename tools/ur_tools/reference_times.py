"""What tests take on two cores: duration in s, and load in cores. Until a checkout has its own measurements."""

from typing import Dict, Tuple

REFERENCE: Dict[str, Tuple[float, float]] = {
}
