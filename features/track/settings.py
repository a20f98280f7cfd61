"""The settings of the tracks, in one place."""

from dataclasses import dataclass

from lightgesture.features.track.motion import CLOSED


@dataclass(frozen=True, slots=True)
class TrackSettings:
    """How tracks are born, followed, lost and replaced. "Sizes" are sizes of the hand in question, the root of width
    times height. Scores that a region or pair must reach are those of SelectorSettings; what is a share here is added
    to them as a share of what is missing to 1.

    The filter:
    filter: "closed" (no library needed) or "filterpy" (the reference; the same answers, slower).
    centre_noise: standard deviation of a region's centre, sizes, 0.02 to 0.3. Measured on the selector's regions.
    size_noise: of its width and height, sizes, 0.1 to 0.6: the forearm comes and goes.
    centre_density, size_density: power spectral densities of acceleration, sizes² / s³, 1 to 200. Larger follows
        faster hands, gates less and trusts a prediction for a shorter time.
    centre_speed, size_speed: standard deviation of a new track's unknown velocity, sizes a second, 0 to 5.

    Association:
    gate: largest squared Mahalanobis distance over four coordinates at which a region is a track's own; 13.3 is the
        99th percentile of chi-squared with four degrees of freedom.
    nearness: what a region at the predicted place is worth beside its score and its pair's, 0.2 to 2. Larger keeps to
        what was seen before, smaller to what looks most like a hand.
    order: what it is worth, on the same scale, that hands of which one went behind the other come back in the order in
        which they met, 0 to 1. Larger takes them for hands that parted again, smaller for hands that crossed.
    leap_noise: standard deviation of the centre and of the size, sizes, 0.2 to 1, by which a hand may leap from one
        frame to the next, for a new sign or a slow camera, where its region is half of a verified pair or believed
        on its own.
    keep_share: least score of a region that a track takes as its own, as a share of the selector's single score,
        0 to 1. Lower bridges weak frames, higher leaves a hand sooner. Where two hands meet, it is the whole of it.
    considered: most regions of a frame that are looked at, best first, 2 to 64; bounds the time.

    Birth, seconds and frames both:
    sure_share: a pair whose score exceeds the selector's by this share is believed at once, 0 to 1.
    pair_s, pair_frames: for how long, and in how many frames, a weaker pair must have been seen.
    single_s, single_frames: the same for a region without a partner.
    margin: by how much the mean score of a pair (or lone region) must exceed that of the present tracks to replace
        them, 0.05 to 0.5. Lower leaves a wrong lock sooner and a right one oftener.
    replace_s: seconds for which the better pair must have been seen, where the present one is seen as well.
    sure_margin: a pair that is better by so much replaces it at once.
    memory_s: time constant of the mean scores, seconds.
    tentative: most regions under observation at a time, 2 to 10; bounds the time.
    tentative_s: seconds after which the observation of a region ends that is gone or no longer scores like a hand.

    Loss:
    coast_s: for so long an unseen hand is taken to go on as it moved, then to rest, 0 to 0.5.
    meet_s: the same for a hand that meets the other one and may pass behind it, 0.1 to 1.
    return_s: for so long a missing hand may return with a region that is only just good enough; later the region
        must be believed on its own or with its partner.
    lost_s: seconds without a region after which a track ends, its number and side with it.
    doubt_s: seconds without a verified pair (or a believed region, for a lone track) after which a track ends.
    longest_step_s: a larger gap in time ends all tracks.
    stalled_step_s: seconds that count as passed where the time of a frame stands still, runs back or is no number.

    Sides:
    settle_s: seconds for which a pair must have been believed before its sides outlive it, 0.2 to 2.
    axis_certainty: factor on the confidence of a lone hand whose side is that of the body's axis; by the picture's
        middle it is the selector's alone_confidence.

    Predictions in place of a search:
    still_iou: overlap of the predicted box with the one found in it, from which the hand stands still enough for a look
        at the box to do, 0 to 1. Larger searches oftener, where hands move, and its boxes are truer.
    whole_s, whole_alone_s: seconds after the last search of a whole frame in which a look at the predicted boxes
        suffices, with two tracks and with one; larger is cheaper and finds a better pair or a second hand later.
    """

    filter: str = CLOSED
    centre_noise: float = 0.12
    size_noise: float = 0.25
    centre_density: float = 10.0
    size_density: float = 4.0
    centre_speed: float = 2.0
    size_speed: float = 0.5
    gate: float = 13.3
    nearness: float = 0.7
    order: float = 0.3
    leap_noise: float = 0.45
    keep_share: float = 0.4
    considered: int = 24
    sure_share: float = 0.2
    pair_s: float = 0.05
    pair_frames: int = 2
    single_s: float = 0.06
    single_frames: int = 3
    margin: float = 0.15
    replace_s: float = 0.1
    sure_margin: float = 0.35
    memory_s: float = 0.2
    tentative: int = 6
    tentative_s: float = 0.15
    coast_s: float = 0.1
    meet_s: float = 0.35
    return_s: float = 0.2
    lost_s: float = 0.6
    doubt_s: float = 1.5
    longest_step_s: float = 1.0
    stalled_step_s: float = 1 / 30
    settle_s: float = 0.5
    axis_certainty: float = 0.9
    still_iou: float = 0.6
    whole_s: float = 0.5
    whole_alone_s: float = 0.1
