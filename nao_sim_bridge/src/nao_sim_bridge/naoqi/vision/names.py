"""Names of the extractors that few ask for, of their events and keys: known before their code is read."""

COLOR_BLOBS, DARKNESS, BACKLIGHTING, RECOGNITION = (
    "ALColorBlobDetection",
    "ALDarknessDetection",
    "ALBacklightingDetection",
    "ALVisionRecognition",
)
COLOR_BLOB, PICTURE = "ALTracker/ColorBlobDetected", "PictureDetected"
DARK, DARKNESS_VALUE = "DarknessDetection/DarknessDetected", "DarknessDetection/DarknessValue"
BACKLIGHT, BACKLIGHT_VALUE = "BacklightingDetection/BacklightingDetected", "BacklightingDetection/BacklightingValue"
