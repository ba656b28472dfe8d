"""Many bearings: what a study's uncertain inputs do to verdict, restitution factor and choice of material."""

from separatrix.explore.uncertain import uncertain_study

__all__ = ["uncertain_study"]
