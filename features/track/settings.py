"""What a user may set of the tracks; what nobody sets stands beside its use."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class TrackSettings:
    """How long hands are followed, and how easily they are left for others. Scores that a region or pair must reach are
    those of SelectorSettings."""

    gate: float = 13.3
    """Largest squared Mahalanobis distance, over centre and size, at which a region is a track's own, 5 to 30. Larger
    follows faster hands and takes more of what is none; 13.3 is the 99th percentile of chi-squared with four degrees of
    freedom."""
    margin: float = 0.15
    """By how much the mean score of a pair (or lone region) must exceed that of the present hands to replace them, 0.05
    to 0.5. Lower leaves a wrong lock sooner and a right one oftener."""
    lost_s: float = 0.6
    """Seconds without a region after which a track ends, its number and side with it, 0.1 to 3."""
    doubt_s: float = 1.5
    """Seconds without a verified pair (or a believed region, for a lone hand) after which a track ends, 0.3 to 5."""
    whole_s: float = 0.5
    """Seconds after the last search of a whole frame in which a look at the predicted boxes suffices, 0 to 2. Larger is
    cheaper and finds a better pair later."""
