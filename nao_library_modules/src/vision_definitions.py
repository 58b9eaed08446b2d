"""Constants of the NAO SDK for ALVideoDevice: cameras, resolutions, colour spaces and parameters.

Names with V and with Y (`kHsvColorSpace`, `kHsyColorSpace`) stand for the same colour spaces: the SDK wrote V
in Python and Y elsewhere.
"""
# ruff: noqa: N816  names are those of the SDK

from __future__ import annotations

# Models.
kOV7670 = 1  # V3
kMT9M114 = 2  # V4 and V5
kOV5640 = 3  # V6
kXTION = 4  # depth camera of other robots

# Cameras.
kTopCamera = 0
kBottomCamera = 1
kDepthCamera = 2
kInfraredCamera = 3

# Resolutions.
kQQVGA = 0  # 160 x 120
kQVGA = 1  # 320 x 240
kVGA = 2  # 640 x 480
k4VGA = 3  # 1280 x 960
k960p = k4VGA
k16VGA = 4  # 2560 x 1920
k1920p = k16VGA
k720p = 5  # 1280 x 720
k1080p = 6  # 1920 x 1080
kQQQVGA = 7  # 80 x 60
kQQQQVGA = 8  # 40 x 30

# Colour spaces; the first nine are one channel each, the one with the capital letter.
kYuvColorSpace = 0
kyUvColorSpace = 1
kyuVColorSpace = 2
kRgbColorSpace = 3
krGbColorSpace = 4
krgBColorSpace = 5
kHsyColorSpace = 6
kHsvColorSpace = kHsyColorSpace
khSyColorSpace = 7
khSvColorSpace = khSyColorSpace
khsYColorSpace = 8
khsVColorSpace = khsYColorSpace
kYUV422ColorSpace = 9
kYUV422InterlacedColorSpace = kYUV422ColorSpace
kYUVColorSpace = 10
kRGBColorSpace = 11
kHSYColorSpace = 12
kHSVColorSpace = kHSYColorSpace
kBGRColorSpace = 13
kYYCbCrColorSpace = 14
kH2RGBColorSpace = 15
kHSMixedColorSpace = 16
kDepthColorSpace = 17
kARGBColorSpace = 18
kXYZColorSpace = 19
kInfraredColorSpace = 20
kDistanceColorSpace = 21
kLabColorSpace = 22
kRawDepthColorSpace = 23
kLuvColorSpace = 24
kLChabColorSpace = 25
kLChuvColorSpace = 26

# How an image is brought to the resolution a client asked for.
kSimpleScaleMethod = 0
kAverageScaleMethod = 1
kQualityScaleMethod = 2
kNoScaling = 3

# Parameters; not every camera has all of them.
kCameraBrightnessID = 0
kCameraContrastID = 1
kCameraSaturationID = 2
kCameraHueID = 3
kCameraRedChromaID = 4
kCameraBlueChromaID = 5
kCameraGainID = 6
kCameraHFlipID = 7
kCameraVFlipID = 8
kCameraLensXID = 9
kCameraLensYID = 10
kCameraAutoExpositionID = 11
kCameraAutoWhiteBalanceID = 12
kCameraAutoGainID = 13
kCameraResolutionID = 14
kCameraFrameRateID = 15
kCameraBufferSizeID = 16
kCameraExposureID = 17
kCameraSelectID = 18
kCameraSetDefaultParamsID = 19
kCameraColorSpaceID = 20
kCameraExposureCorrectionID = 21
kCameraExposureAlgorithmID = 22
kCameraAecAlgorithmID = kCameraExposureAlgorithmID
kCameraFastSwitchID = 23
kCameraSharpnessID = 24
kCameraAwbGreenGainID = 25
kCameraAblcID = 26
kCameraAblcTargetID = 27
kCameraAblcStableRangeID = 28
kCameraBlcBlueID = 29
kCameraBlcRedID = 30
kCameraBlcGbID = 31
kCameraBlcGrID = 32
kCameraWhiteBalanceID = 33
kCameraBacklightCompensationID = 34
kCameraKeepAliveID = 35
kCameraDepthConfidenceThresholdID = 36
kCameraDepthFastFilterID = 37
kCameraTemperatureID = 38
kCameraAverageLuminanceID = 39
kCameraAutoFocusID = 40
kCameraFocusID = 43
