"""Which of NAOqi's methods the simulated robot answers: every one is called once with valid arguments."""

from __future__ import annotations

import pytest

from nao_sim_bridge.services.api import COMMON, module_methods
from nao_sim_bridge.services.binding import offered

HEAD = ["HeadYaw", "HeadPitch"]
# The left hand in the frame of the torso (0), by position only (7).
HAND = [0.12, 0.12, 0.0, 0.0, 0.0, 0.0]
HAND_MATRIX = [1.0, 0.0, 0.0, 0.12, 0.0, 1.0, 0.0, 0.12, 0.0, 0.0, 1.0, 0.0]
# A handle that makes a straight line.
LINE = [1, 0.0, 0.0]
NO_CHANGE = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]
KEY, EVENT = "Test/Key", "Test/Event"
# A sound that is shipped, and the id of one that plays in a loop.
SOUND, LOADED = "nao_library/bip.ogg", object()
POSTED = object()  # the id of a call that was posted to the module
# Method -> arguments.
COMMON_CALLS = {
    "clearStats": (),
    "getBrokerName": (),
    "getMethodHelp": ("ping",),
    "getMethodList": (),
    "getModuleHelp": (),
    "getUsage": ("ping",),
    "isRunning": (POSTED,),
    "isStatsEnabled": (),
    "isTraceEnabled": (),
    "pCall": ("ping",),
    "ping": (),
    "stop": (POSTED,),
    "version": (),
    "wait": (POSTED, 0),
}
# Of all extractors; for those about a subscriber see `BEFORE`.
EXTRACTOR_CALLS = {
    "getCurrentPeriod": (),
    "getCurrentPrecision": (),
    "getEventList": (),
    "getMemoryKeyList": (),
    "getMyPeriod": ("Listener",),
    "getMyPrecision": ("Listener",),
    "getOutputNames": (),
    "getSubscribersInfo": (),
    "subscribe": ("Listener", 100, 0.5),
    "unsubscribe": ("Listener",),
    "updatePeriod": ("Listener", 100),
    "updatePrecision": ("Listener", 0.5),
}
# Of the extractors that listen for sounds.
LISTENING_CALLS = {
    **EXTRACTOR_CALLS,
    "isPaused": (),
    "isProcessing": (),
    "pause": (False,),
    "setParameter": ("Sensitivity", 0.9),
}
# Of the extractors that look through a camera.
LOOKING_CALLS = {
    **EXTRACTOR_CALLS,
    "getActiveCamera": (),
    "getFrameRate": (),
    "getResolution": (),
    "isPaused": (),
    "isProcessing": (),
    "pause": (False,),
    "setActiveCamera": (1,),
    "setFrameRate": (10,),
    "setResolution": (1,),
}
CALLS = {
    "ALBarcodeReader": LOOKING_CALLS,
    "ALLandMarkDetection": {**LOOKING_CALLS, "setParameter": ("pause", False)},
    "ALRedBallDetection": EXTRACTOR_CALLS,
    "ALAudioSourceLocalization": LISTENING_CALLS,
    "ALSoundDetection": LISTENING_CALLS,
    "ALSoundLocalization": LISTENING_CALLS,
    "ALMemory": {
        "addMapping": ("Listener", "moved", EVENT),
        "declareEvent": (EVENT, "Extractor"),
        "getData": (KEY,),
        "getDataList": ("Test",),
        "getDataListName": (),
        "getDescriptionList": ([KEY],),
        "getEventHistory": (EVENT,),
        "getEventList": (),
        "getExtractorEvent": ("Extractor",),
        "getListData": ([KEY],),
        "getMicroEventList": (),
        "getSubscribers": (EVENT,),
        "getTimestamp": (KEY,),
        "getType": (KEY,),
        "insertData": (KEY, 1),
        "insertListData": ([[KEY, 1]],),
        "raiseEvent": (EVENT, 1),
        "raiseMicroEvent": ("Test/Micro", 1),
        "removeData": (KEY,),
        "removeEvent": (EVENT,),
        "removeMicroEvent": ("Test/Micro",),
        "setDescription": (KEY, "text"),
        "subscribeToEvent": (EVENT, "Listener", "onEvent"),
        "subscribeToMicroEvent": ("Test/Micro", "Listener", "message", "onEvent"),
        "subscriber": (EVENT,),
        "unregisterModuleReference": ("Listener",),
        "unsubscribeToEvent": (EVENT, "Listener"),
        "unsubscribeToMicroEvent": ("Test/Micro", "Listener"),
    },
    "ALVideoDevice": {
        "closeCamera": (0,),
        "getActiveCamera": (),
        "getActiveCameras": ("Lookers_0",),
        "getAngPosFromImgPos": ([0.5, 0.5],),
        "getAngSizeFromImgSize": ([0.1, 0.1],),
        "getAngularPositionFromImagePosition": (0, [0.5, 0.5]),
        "getAngularSizeFromImageSize": (0, [0.1, 0.1]),
        "getCameraIndexes": (),
        "getCameraModel": (0,),
        "getCameraModelID": (),
        "getCameraName": (0,),
        "getCameraParameter": ("Looker_0", 0),
        "getCameraParameterInfo": ("Looker_0", 0),
        "getCameraParameterRange": ("Looker_0", 0),
        "getCamerasParameter": ("Lookers_0", 0),
        "getColorSpace": ("Looker_0",),
        "getColorSpaces": ("Lookers_0",),
        "getDirectRawImageRemote": ("Looker_0",),
        "getDirectRawImagesRemote": ("Lookers_0",),
        "getExpectedImageParameters": (0,),
        "getFrameRate": ("Looker_0",),
        "getGVMColorSpace": ("Looker_0",),
        "getGVMFrameRate": ("Looker_0",),
        "getGVMResolution": ("Looker_0",),
        "getHorizontalAperture": (0,),
        "getHorizontalFOV": (0,),
        "getImageInfoFromAngularInfo": (0, [0.1, 0.1, 0.1, 0.1]),
        "getImageInfoFromAngularInfoWithResolution": (0, [0.1, 0.1, 0.1, 0.1], 2),
        "getImagePositionFromAngularPosition": (0, [0.1, 0.1]),
        "getImageRemote": ("Looker_0",),
        "getImageSizeFromAngularSize": (0, [0.1, 0.1]),
        "getImagesRemote": ("Lookers_0",),
        "getImgInfoFromAngInfo": ([0.1, 0.1, 0.1, 0.1],),
        "getImgInfoFromAngInfoWithRes": ([0.1, 0.1, 0.1, 0.1], 2),
        "getImgPosFromAngPos": ([0.1, 0.1],),
        "getImgSizeFromAngSize": ([0.1, 0.1],),
        "getParam": (0,),
        "getParameter": (0, 0),
        "getParameterInfo": (0, 0),
        "getParameterRange": (0, 0),
        "getResolution": ("Looker_0",),
        "getResolutions": ("Lookers_0",),
        "getSubscribers": (),
        "getVIMColorSpace": (),
        "getVIMFrameRate": (),
        "getVIMResolution": (),
        "getVerticalAperture": (0,),
        "getVerticalFOV": (0,),
        "hasDepthCamera": (),
        "isCameraOpen": (0,),
        "isCameraStarted": (0,),
        "isFrameGrabberOff": (0,),
        "onClientDisconnected": ("ClientDisconnected", "nobody", ""),
        "openCamera": (0,),
        "putImage": (0, 4, 2, bytes(24)),
        "recordVideo": ("Looker_0", "raw.bin", 1, 1),
        "releaseDirectRawImage": ("Looker_0",),
        "releaseDirectRawImages": ("Lookers_0",),
        "releaseImage": ("Looker_0",),
        "releaseImages": ("Lookers_0",),
        "resetCamera": (0,),
        "resolutionToSizes": (2,),
        "setActiveCamera": (0,),
        "setActiveCameras": ("Lookers_0", [1, 0]),
        "setAllCameraParametersToDefault": ("Looker_0",),
        "setAllParametersToDefault": (0,),
        "setCameraParameter": ("Looker_0", 0, 1),
        "setCameraParameterToDefault": ("Looker_0", 0),
        "setCamerasParameter": ("Lookers_0", 0, [1, 1]),
        "setCamerasParameterToDefault": ("Lookers_0", 0),
        "setColorSpace": ("Looker_0", 11),
        "setColorSpaces": ("Lookers_0", [11, 11]),
        "setFrameRate": ("Looker_0", 5),
        "setParam": (0, 1),
        "setParamDefault": (0,),
        "setParameter": (0, 0, 1),
        "setParameterToDefault": (0, 0),
        "setResolution": ("Looker_0", 2),
        "setResolutions": ("Lookers_0", [2, 2]),
        "setSimCamInputSize": (640, 480),
        "sizesToResolution": (640, 480),
        "startCamera": (0,),
        "startFrameGrabber": (0,),
        "stopCamera": (0,),
        "stopFrameGrabber": (0,),
        "stopVideo": ("Looker_0",),
        "subscribe": ("Old", 1, 11, 15),
        "subscribeCamera": ("Another", 0, 1, 11, 15),
        "subscribeCameras": ("More", [0, 1], [1, 1], [11, 11], 15),
        "unsubscribe": ("Looker_0",),
        "unsubscribeAllInstances": ("Looker",),
    },
    "ALAudioDevice": {
        "closeAudioInputs": (),
        "closeAudioOutputs": (),
        "defaultInput": (),
        "defaultOutput": (),
        "disableEnergyComputation": (),
        "enableEnergyComputation": (),
        "flushAudioOutputs": (),
        "getFrontMicEnergy": (),
        "getLeftMicEnergy": (),
        "getOutputVolume": (),
        "getParameter": ("outputSampleRate",),
        "getRearMicEnergy": (),
        "getRightMicEnergy": (),
        "input": (0,),
        "isAudioOutMuted": (),
        "isInputClosed": (),
        "isOutputClosed": (),
        "listInputs": (),
        "listOutputs": (),
        "muteAudioOut": (False,),
        "openAudioInputs": (),
        "openAudioOutputs": (),
        "output": (0,),
        "playSine": (440, 50, 0, 0.1),
        "sendRemoteBufferToOutput": (1, b"abcd"),
        "setClientPreferences": ("Listener", 48000, 0, 0),
        "setDefaultInput": (0,),
        "setDefaultOutput": (0,),
        "setFileAsInput": ("nao_library/bip.ogg",),
        "setOutputVolume": (50,),
        "setParameter": ("outputSampleRate", 22050),
        "startMicrophonesRecording": ("device.wav",),
        "stopMicrophonesRecording": (),
        "subscribe": ("Listener",),
        "unsubscribe": ("Listener",),
    },
    "ALAudioPlayer": {
        "disablePitch": (LOADED,),
        "getCurrentPosition": (LOADED,),
        "getFileLength": (LOADED,),
        "getInstalledSoundSetsList": (),
        "getLoadedFilesIds": (),
        "getLoadedFilesNames": (),
        "getLoadedSoundSetsList": (),
        "getMasterVolume": (),
        "getSoundSetFileNames": ("nao_library",),
        "getVolume": (LOADED,),
        "goTo": (LOADED, 0.1),
        "isSoundSetFileInstalled": ("nao_library", "bip"),
        "isSoundSetInstalled": ("nao_library",),
        "isSoundSetLoaded": ("nao_library",),
        "loadFile": (SOUND,),
        "loadSoundSet": ("nao_library",),
        "pause": (LOADED,),
        "play": (LOADED,),
        "playFile": (SOUND,),
        "playFileFromPosition": (SOUND, 0.1),
        "playSine": (440, 50, 0, 0.1),
        "playSoundSetFile": ("bip",),
        "setMasterVolume": (0.5,),
        "setPanorama": (0.5,),
        "setPitch": (LOADED, 1.5),
        "setVolume": (LOADED, 0.5),
        "stopAll": (),
        "unloadFile": (LOADED,),
        "unloadSoundSet": ("nao_library",),
        "unloadAllFiles": (),
    },
    "ALAudioRecorder": {
        "startMicrophonesRecording": ("recorder.wav", "wav", 48000, [1, 1, 1, 1]),
        "stopMicrophonesRecording": (),
    },
    "ALLeds": {
        "createGroup": ("TestGroup", ["Brain0"]),
        "earLedsSetAngle": (90, 0.1, False),
        "fade": ("FaceLeds", 0.5, 0.1),
        "fadeListRGB": ("FaceLeds", [0xFF], [0.1]),
        "fadeRGB": ("FaceLeds", "red", 0.1),
        "getIntensity": ("Brain0",),
        "listGroup": ("FaceLeds",),
        "listGroups": (),
        "listLED": ("Brain0",),
        "listLEDs": (),
        "off": ("FaceLeds",),
        "on": ("FaceLeds",),
        "randomEyes": (0.1,),
        "rasta": (0.1,),
        "reset": ("FaceLeds",),
        "rotateEyes": (0xFF, 0.1, 0.1),
        "setIntensity": ("FaceLeds", 0.5),
    },
    "ALMotion": {
        "angleInterpolation": (HEAD, [0.1, 0.1], 0.1, True),
        "angleInterpolationBezier": (HEAD, [[0.2], [0.2]], [[[0.1, LINE, LINE]], [[0.1, LINE, LINE]]]),
        "angleInterpolationWithSpeed": (HEAD, [0.1, 0.1], 1.0),
        "animation": (HEAD, [[0.2], [0.2]], [[[0.1, LINE, LINE]], [[0.1, LINE, LINE]]], True, []),
        "areNotificationsEnabled": (),
        "areResourcesAvailable": (HEAD,),
        "changeAngles": (HEAD, 0.1, 0.5),
        "changePosition": ("LArm", 0, [0.01, 0.0, 0.0, 0.0, 0.0, 0.0], 0.5, 7),
        "changeTransform": ("LArm", 0, NO_CHANGE, 0.5, 7),
        "closeHand": ("LHand",),
        "getAngles": ("Body", True),
        "getBodyNames": ("Body",),
        "getBreathConfig": (),
        "getBreathEnabled": ("Body",),
        "getChainClosestObstaclePosition": ("LArm", 0),
        "getCollisionProtectionEnabled": ("Arms",),
        "getCOM": ("Body", 2, True),
        "getDiagnosisEffectEnabled": (),
        "getExternalCollisionProtectionEnabled": ("All",),
        "getFallManagerEnabled": (),
        "getFootGaitConfig": ("Default",),
        "getFootSteps": (),
        "getIdlePostureEnabled": ("Body",),
        "getJointNames": ("Body",),
        "getLimits": ("Body",),
        "getMass": ("Body",),
        "getMotionCycleTime": (),
        "getMoveArmsEnabled": ("Arms",),
        "getMoveConfig": ("Max",),
        "getNextRobotPosition": (),
        "getOrthogonalSecurityDistance": (),
        "getPosition": ("LArm", 0, True),
        "getPushRecoveryEnabled": (),
        "getRobotConfig": (),
        "getRobotPosition": (True,),
        "getRobotVelocity": (),
        "getSensorNames": (),
        "getSmartStiffnessEnabled": (),
        "getStiffnesses": ("Body",),
        "getSummary": (),
        "getSupportPolygon": (2, True),
        "getTangentialSecurityDistance": (),
        "getTaskList": (),
        "getTransform": ("LArm", 0, True),
        "getWalkArmsEnabled": (),
        "isCollision": ("Arms",),
        "killAll": (),
        "killMove": (),
        "killTask": (1,),
        "killTasksUsingResources": (HEAD,),
        "killWalk": (),
        "move": (0.05, 0.0, 0.0),
        "moveInit": (),
        "moveIsActive": (),
        "moveTo": (0.02, 0.0, 0.0),
        "moveToward": (0.5, 0.0, 0.0),
        "openHand": ("LHand",),
        "positionInterpolation": ("LArm", 0, HAND, 7, [0.5], True),
        "positionInterpolations": (["LArm"], 0, [HAND], [7], [0.5], True),
        "rest": (),
        "robotIsWakeUp": (),
        "setAngles": (HEAD, 0.1, 0.5),
        "setBreathConfig": ([["Bpm", 12.0], ["Amplitude", 0.5]],),
        "setBreathEnabled": ("Body", False),
        "setCollisionProtectionEnabled": ("Arms", True),
        "setDiagnosisEffectEnabled": (True,),
        "setEnableNotifications": (True,),
        "setExternalCollisionProtectionEnabled": ("All", True),
        "setFallManagerEnabled": (True,),
        "setFootSteps": (["LLeg"], [[0.0, 0.1, 0.0]], [0.6], False),
        "setFootStepsWithSpeed": (["LLeg"], [[0.0, 0.1, 0.0]], [1.0], False),
        "setIdlePostureEnabled": ("Body", False),
        "setMotionConfig": ([["ENABLE_STIFFNESS_PROTECTION", True]],),
        "setMoveArmsEnabled": (True, True),
        "setOrthogonalSecurityDistance": (0.4,),
        "setPosition": ("LArm", 0, HAND, 0.5, 7),
        "setPositions": ("LArm", 0, HAND, 0.5, 7),
        "setPushRecoveryEnabled": (True,),
        "setSmartStiffnessEnabled": (True,),
        "setStiffnesses": ("Body", 1.0),
        "setTangentialSecurityDistance": (0.1,),
        "setTransform": ("LArm", 0, HAND_MATRIX, 0.5, 7),
        "setTransforms": ("LArm", 0, HAND_MATRIX, 0.5, 7),
        "setWalkArmsEnabled": (True, True),
        "setWalkTargetVelocity": (0.5, 0.0, 0.0, 1.0),
        "stiffnessInterpolation": (HEAD, 1.0, 0.1),
        "stopMove": (),
        "stopWalk": (),
        "transformInterpolation": ("LArm", 0, HAND_MATRIX, 7, [0.5], True),
        "transformInterpolations": (["LArm"], 0, [HAND_MATRIX], [7], [0.5], True),
        "waitUntilMoveIsFinished": (),
        "waitUntilWalkIsFinished": (),
        "wakeUp": (),
        "walkInit": (),
        "walkIsActive": (),
        "walkTo": (0.02, 0.0, 0.0),
        "wbEnable": (True,),
        "wbEnableBalanceConstraint": (True, "Legs"),
        "wbEnableEffectorControl": ("LArm", True),
        "wbEnableEffectorOptimization": ("Head", True),
        "wbFootState": ("Fixed", "Legs"),
        "wbGoToBalance": ("Legs", 0.5),
        "wbGoToBalanceWithSpeed": ("Legs", 1.0),
        "wbSetEffectorControl": ("LArm", [0.12, 0.12, 0.3]),
    },
    "ALRobotPosture": {
        "applyPosture": ("Stand", 1.0),
        "getPosture": (),
        "getPostureFamily": (),
        "getPostureFamilyList": (),
        "getPostureList": (),
        "goToPosture": ("Stand", 1.0),
        "setMaxTryNumber": (3,),
        "stopMove": (),
    },
    "ALSpeechRecognition": {
        **EXTRACTOR_CALLS,
        "eraseContextSet": ("test",),
        "getAudioExpression": (),
        "getAvailableLanguages": (),
        "getLanguage": (),
        "getParameter": ("Sensitivity",),
        "pause": (False,),
        "pushContexts": (),
        "removeAllContext": (),
        "saveContextSet": ("test",),
        "setAudioExpression": (False,),
        "setLanguage": ("English",),
        "setParameter": ("NbHypotheses", 1),
        "setVisualExpression": (True,),
        "setVisualExpressionMode": (1,),
        "setVocabulary": (["yes", "no"], False),
        "setWordListAsVocabulary": (["yes", "no"],),
    },
    "ALSystem": {
        "diskFree": (True,),
        "freeMemory": (),
        "previousSystemVersion": (),
        "reboot": (),
        "robotName": (),
        "setRobotName": ("nao",),
        "setTimezone": ("UTC",),
        "systemInfo": (),
        "systemVersion": (),
        "timezone": (),
        "totalMemory": (),
    },
    "ALTextToSpeech": {
        "addToDictionary": ("Nao", "now"),
        "deleteFromDictionary": ("Nao",),
        "disableNotifications": (),
        "enableNotifications": (),
        "getAvailableLanguages": (),
        "getAvailableVoices": (),
        "getLanguage": (),
        "getLanguageEncoding": ("English",),
        "getParameter": ("speed",),
        "getSupportedLanguages": (),
        "getVoice": (),
        "getVolume": (),
        "locale": (),
        "reset": (),
        "resetSpeed": (),
        "say": ("One.",),
        "sayToFile": ("One.", "one.wav"),
        "sayToFileAndPlay": ("One.",),
        "setLanguage": ("English",),
        "setLanguageDefaultVoice": ("English", "naoenu"),
        "setParameter": ("pitchShift", 1.0),
        "setVoice": ("naoenu",),
        "setVolume": (1.0,),
        "showDictionary": (),
        "stopAll": (),
    },
    "ALFaceDetection": {
        **EXTRACTOR_CALLS,
        "clearDatabase": (),
        "enableRecognition": (True,),
        "enableTracking": (True,),
        "forgetPerson": ("nobody",),
        "getActiveCamera": (),
        "getFrameRate": (),
        "getLearnedFacesList": (),
        "getRecognitionConfidenceThreshold": (),
        "getResolution": (),
        "importOldDatabase": ("keep",),
        "isPaused": (),
        "isProcessing": (),
        "isRecognitionEnabled": (),
        "isTrackingEnabled": (),
        "learnFace": ("nobody",),
        "pause": (False,),
        "reLearnFace": ("nobody",),
        "setActiveCamera": (0,),
        "setFrameRate": (10,),
        "setParameter": ("resolution", 2),
        "setRecognitionConfidenceThreshold": (0.4,),
        "setRecognitionEnabled": (True,),
        "setResolution": (2,),
        "setTrackingEnabled": (True,),
    },
    "ALMovementDetection": {
        **EXTRACTOR_CALLS,
        "getActiveCamera": (),
        "getColorSensitivity": (),
        "getDepthSensitivity": (),
        "getFrameRate": (),
        "getResolution": (),
        "isPaused": (),
        "isProcessing": (),
        "pause": (False,),
        "resetDetection": (),
        "setActiveCamera": (0,),
        "setColorSensitivity": (0.8,),
        "setDepthSensitivity": (0.3,),
        "setFrameRate": (10,),
        "setResolution": (1,),
    },
    "ALPhotoCapture": {
        "getCameraID": (),
        "getCaptureInterval": (),
        "getColorSpace": (),
        "getPictureFormat": (),
        "getResolution": (),
        "halfPress": (),
        "isHalfPressEnabled": (),
        "isHalfPressed": (),
        "setCameraID": (0,),
        "setCaptureInterval": (200,),
        "setColorSpace": (13,),
        "setHalfPressEnabled": (False,),
        "setPictureFormat": ("jpg",),
        "setResolution": (2,),
        "takePicture": ("photos", "one", True),
        "takePictures": (2, "photos", "two"),
    },
    "ALVideoRecorder": {
        "getCameraID": (),
        "getColorSpace": (),
        "getFrameRate": (),
        "getResolution": (),
        "getVideoFormat": (),
        "isRecording": (),
        "setCameraID": (1,),  # the other one has been stopped above
        "setColorSpace": (13,),
        "setFrameRate": (15.0,),
        "setResolution": (1,),
        "setVideoFormat": ("MJPG",),
        "startRecording": ("films", "one", True),
        "stopRecording": (),
    },
    "ALAnimatedSpeech": {
        "addTagsToWords": ({"hello": ["ahoy"]},),
        "declareTagForAnimations": ({"ahoy": ["animations/Stand/Gestures/Hey_1"]},),
        "getBodyLanguageMode": (),
        "getBodyLanguageModeToStr": (),
        "isBodyLanguageEnabled": (),
        "isBodyTalkEnabled": (),
        "say": ("One.", {"bodyLanguageMode": "disabled"}),
        "setBodyLanguageEnabled": (True,),
        "setBodyLanguageMode": (2,),
        "setBodyLanguageModeFromStr": ("contextual",),
        "setBodyTalkEnabled": (True,),
    },
}
# Answered, but not with success, or not by a robot that is still needed: tests of their own.
ELSEWHERE = {
    "ALAudioDevice": {"sendLocalBufferToOutput"},
    "ALAudioPlayer": {"playFileInLoop", "playInLoop", "playWebStream"},
    "ALMemory": {"getDataOnChange", "getDataPtr", "getFloatPtr", "getIntPtr"},
    "ALSpeechRecognition": {
        "activateAllRules",
        "activateRule",
        "addContext",
        "addWordListToSlot",
        "compile",
        "deactivateAllRules",
        "deactivateRule",
        "getContextParam",
        "getRules",
        "loadContextSet",
        "loadVocabulary",
        "popContexts",
        "removeContext",
        "removeWordListFromSlot",
        "setContextParam",
    },
    "ALSystem": {"shutdown"},
    "ALVideoDevice": {"getDirectRawImageLocal", "getDirectRawImagesLocal", "getImageLocal", "getImagesLocal"},
    "ALAnimatedSpeech": {"declareAnimationsPackage"},
    "ALTextToSpeech": {"loadVoicePreference"},
    COMMON: {"exit"},
}
# What has to be called first: module and method -> method, arguments.
BEFORE = {
    ("ALAudioDevice", "unsubscribe"): ("subscribe", "Listener"),
    ("ALAudioPlayer", "playSoundSetFile"): ("loadSoundSet", "nao_library"),
    ("ALSpeechRecognition", "eraseContextSet"): ("saveContextSet", "test"),
    ("ALSpeechRecognition", "pushContexts"): ("pause", True),
    ("ALSpeechRecognition", "removeAllContext"): ("pause", True),
    ("ALSpeechRecognition", "setVocabulary"): ("pause", True),
    ("ALSpeechRecognition", "setWordListAsVocabulary"): ("pause", True),
    ("ALAudioPlayer", "unloadSoundSet"): ("loadSoundSet", "nao_library"),
    ("ALVideoDevice", "stopVideo"): ("recordVideo", "Looker_0", "stopped.bin", 10, 1),
    ("ALVideoRecorder", "stopRecording"): ("isRecording",),
}
OF_A_SUBSCRIBER = ("getMyPeriod", "getMyPrecision", "unsubscribe", "updatePeriod", "updatePrecision")
for extractor in [module for module, calls in CALLS.items() if "getSubscribersInfo" in calls]:
    BEFORE.update({(extractor, method): ("subscribe", "Listener") for method in OF_A_SUBSCRIBER})
# What would flash the robot's disk or change its users, and its picture: a simulation has neither.
MISSING_IN_SYSTEM = {
    "appBackupInfo",
    "changePassword",
    "factoryReset",
    "robotIcon",
    "setRobotIcon",
    "upgrade",
}
# Answered by a robot on stiff legs only; it may still walk then.
WALKS = {
    "move",
    "moveInit",
    "moveTo",
    "moveToward",
    "setFootSteps",
    "setFootStepsWithSpeed",
    "setWalkTargetVelocity",
    "walkInit",
    "walkTo",
}
LONGEST = 8.0
"""No call takes longer than this, in s of simulated time."""


@pytest.fixture
def answers(shared_robot):
    """Names of the methods that a module answers and those it does not, without the common ones."""
    common = set(module_methods(COMMON))

    def of(module):
        return [set(names) - common for names in offered(module, shared_robot.server.modules()[module])]

    return of


COMPLETE = [
    ("ALMemory", 32),
    ("ALLeds", 17),
    ("ALMotion", 104),
    ("ALRobotPosture", 8),
    ("ALAudioPlayer", 33),
    ("ALAudioDevice", 36),
    ("ALAudioRecorder", 2),
    ("ALTextToSpeech", 26),
    ("ALAnimatedSpeech", 12),
    ("ALAudioSourceLocalization", 16),
    ("ALSoundDetection", 16),
    ("ALSoundLocalization", 16),
    ("ALSpeechRecognition", 43),
    ("ALVideoDevice", 95),
    ("ALPhotoCapture", 16),
    ("ALVideoRecorder", 13),
    ("ALFaceDetection", 36),
    ("ALMovementDetection", 26),
    ("ALRedBallDetection", 12),
    ("ALLandMarkDetection", 22),
    ("ALBarcodeReader", 21),
]


@pytest.mark.parametrize("module, count", COMPLETE)
def test_these_modules_answer_all_their_methods(answers, module, count):
    answered, missing = answers(module)
    assert missing == set()
    assert len(answered) == count


def test_system_answers_all_that_makes_sense_in_a_simulation(answers):
    assert answers("ALSystem")[1] == MISSING_IN_SYSTEM


@pytest.mark.parametrize("module", CALLS)
def test_every_method_that_is_answered_is_called_below(answers, module):
    assert answers(module)[0] == set(CALLS[module]) | ELSEWHERE.get(module, set())


def test_the_common_methods_are_called_below():
    assert set(module_methods(COMMON)) == set(COMMON_CALLS) | ELSEWHERE[COMMON]


@pytest.fixture
def prepared(shared_robot, shared_listener):
    """Keys, events, subscriptions and a posted call, which the calls are about."""
    memory = shared_robot.ALMemory
    memory.insertData(KEY, 0)
    memory.raiseEvent(EVENT, 0)
    memory.raiseMicroEvent("Test/Micro", 0)
    memory.subscribeToEvent(EVENT, "Listener", "onEvent")
    memory.subscribeToMicroEvent("Test/Micro", "Listener", "message", "onEvent")
    shared_robot.posted = {module: getattr(shared_robot, module).pCall("ping") for module in CALLS}
    shared_robot.loaded = shared_robot.ALAudioPlayer.loadFile(SOUND)
    shared_robot.ALAudioPlayer.pCall("playInLoop", shared_robot.loaded)
    video = shared_robot.ALVideoDevice
    video.subscribeCamera("Looker", 0, 1, 9, 15)
    video.subscribeCameras("Lookers", [0, 1], [1, 1], [9, 9], 15)
    yield shared_robot
    shared_robot.ALAudioPlayer.unloadAllFiles()
    for handle in video.getSubscribers():
        video.unsubscribe(handle)


@pytest.mark.parametrize("module, method", [(module, method) for module, calls in CALLS.items() for method in calls])
def test_a_method_answers(prepared, module, method):
    if method in WALKS:
        prepared.NaoSimulation.reset()
        prepared.ALMotion.setStiffnesses("Body", 1.0)
        prepared.advance(0.1)
    begun = prepared.now.time
    if (module, method) in BEFORE:
        prepared.advance(0.25)  # what the method before has begun is over
        getattr(prepared, module).call(*BEFORE[module, method])
        prepared.advance(0.25)  # and what this begins has begun: a film has a picture
    future = prepared.post(module, method, *(prepared.loaded if a is LOADED else a for a in CALLS[module][method]))
    prepared.handed_over(module)
    while future.isRunning() and prepared.now.time < begun + LONGEST:
        prepared.advance(0.25)
    prepared.answer(future)


@pytest.mark.parametrize("module", CALLS)
@pytest.mark.parametrize("method", COMMON_CALLS)
def test_a_common_method_answers_in_every_module(prepared, module, method):
    posted = prepared.posted[module]
    getattr(prepared, module).call(method, *(posted if a is POSTED else a for a in COMMON_CALLS[method]))
